// base/log.h - warnings and notes for people, on standard error, kept for the statistics.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace obscura {

enum class Verbosity { quiet, normal, verbose };

/// Collects and prints messages. One object per command, handed down by reference; thread-safe.
///
/// Names that come from an asset may hold control characters: every line is escaped.
class Log {
public:
    explicit Log(Verbosity verbosity = Verbosity::normal) : verbosity_(verbosity) {}

    /// "WARN where: text"; kept for --stats. Printed unless quiet.
    void warn(std::string_view where, std::string_view text);
    /// "INFO text"; printed unless quiet.
    void info(std::string_view text);
    /// "INFO text"; printed only when verbose.
    void detail(std::string_view text);

    /// All warnings so far, each as "where: text", in the order they came.
    std::vector<std::string> warnings() const;
    Verbosity verbosity() const { return verbosity_; }

private:
    Verbosity verbosity_;
    mutable std::mutex mutex_;
    std::vector<std::string> warnings_;
};

/// Replaces control characters (also ESC and DEL) and broken UTF-8 by \xNN.
std::string escape_control(std::string_view text);

}  // namespace obscura
