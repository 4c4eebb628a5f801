// base/log.h - collects warnings and notes, and hands them to a sink.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/setting_names.h"

#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace obscura {

enum class Verbosity { quiet, normal, verbose };

/// A message for a sink: escaped, with the names of settings spelled.
struct LogMessage {
    bool is_warning;
    std::string_view where;  ///< of a warning
    std::string_view text;
};

/// Shows a message; called from any thread, but never by two at once.
using LogSink = std::function<void(const LogMessage&)>;

/// Collects messages and hands them to a sink. One object per command or session, handed down by
/// reference; thread-safe.
///
/// Names that come from an asset may hold control characters: every line is escaped.
class Log {
public:
    /// Without a sink nothing is shown.
    explicit Log(Verbosity verbosity = Verbosity::normal,
                 LogSink sink = {},
                 SettingNames names = SettingNames::plain)
        : verbosity_(verbosity), sink_(std::move(sink)), names_(names) {}

    /// Kept for --stats; shown unless quiet.
    void warn(std::string_view where, std::string_view text);
    /// Kept as warn() does, but not shown: somebody has seen it before.
    void warn_again(std::string_view where, std::string_view text);
    /// Shown unless quiet.
    void info(std::string_view text);
    /// As info(), but only when verbose.
    void detail(std::string_view text);

    /// All warnings so far, each as "where: text", in the order they came.
    std::vector<std::string> warnings() const;
    Verbosity verbosity() const { return verbosity_; }

private:
    std::string shown(std::string_view text) const;

    Verbosity verbosity_;
    LogSink sink_;
    SettingNames names_;
    mutable std::mutex mutex_;
    std::vector<std::string> warnings_;
};

/// Replaces control characters (also ESC and DEL) and broken UTF-8 by \xNN.
std::string escape_control(std::string_view text);

}  // namespace obscura
