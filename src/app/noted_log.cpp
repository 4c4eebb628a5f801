// app/noted_log.cpp - notes of what was said, to be said again.
// SPDX-License-Identifier: Apache-2.0
#include "app/noted_log.h"

namespace obscura::app {

namespace {

/// Who notes what is said wants to know it even where nobody is shown anything.
Verbosity at_least_normal(Verbosity verbosity) {
    return verbosity == Verbosity::verbose ? verbosity : Verbosity::normal;
}

}  // namespace

void Notes::add(const LogMessage& message) {
    notes_.push_back({message.is_warning, std::string(message.where), std::string(message.text)});
}

void Notes::tell(Log& log) {
    const LogSink say = passed_to(log);
    for (const Note& note : notes_) {
        if (!is_told_) {
            say({note.is_warning, note.where, note.text});
        } else if (note.is_warning) {
            log.warn_again(note.where, note.text);
        }
    }
    is_told_ = true;
}

Log noted_log(Log& log, Notes& notes) {
    notes.mark_told();
    return Log(
        at_least_normal(log.verbosity()),
        [pass_on = passed_to(log), &notes](const LogMessage& message) {
            notes.add(message);
            pass_on(message);
        },
        SettingNames::options);
}

Log noting_log(Verbosity verbosity, Notes& notes) {
    return Log(
        at_least_normal(verbosity),
        [&notes](const LogMessage& message) { notes.add(message); },
        SettingNames::options);
}

LogSink passed_to(Log& log) {
    return [&log](const LogMessage& message) {
        if (message.is_warning) {
            log.warn(message.where, message.text);
        } else {
            log.info(message.text);
        }
    };
}

}  // namespace obscura::app
