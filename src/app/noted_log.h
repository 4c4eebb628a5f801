// app/noted_log.h - notes of what was said, to be said again.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/log.h"

#include <string>
#include <vector>

namespace obscura::app {

/// What was said of something that several renderings have in common, in the order it came.
class Notes {
public:
    void add(const LogMessage& message);

    /// Says all of it; after the first time, only adds its warnings to those of the log.
    void tell(Log& log);
    void mark_told() { is_told_ = true; }
    bool is_told() const { return is_told_; }
    /// It was told to nobody who listens.
    void forget_telling() { is_told_ = false; }

private:
    struct Note {
        bool is_warning;
        std::string where, text;
    };
    std::vector<Note> notes_;
    bool is_told_ = false;
};

/// A log that passes everything on to another one and takes notes, which are told thereby. Both
/// must outlive it.
Log noted_log(Log& log, Notes& notes);

/// A log that only takes notes: those that one of this verbosity would show, or that are kept.
Log noting_log(Verbosity verbosity, Notes& notes);

/// A sink that says everything to another log, which must outlive it.
LogSink passed_to(Log& log);

}  // namespace obscura::app
