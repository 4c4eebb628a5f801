// app/outcome.h - ends a command: message for people, result line, exit code.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"

#include <string>

namespace obscura::app {

/// The log of a command: "WARN where: text" and "INFO text" on standard error; settings are named
/// as command line options.
class TerminalLog : public Log {
public:
    explicit TerminalLog(Verbosity verbosity = Verbosity::normal);
};

/// "RESULT code=65 id=E-ACC-TOOLONG where=scene.glb#/accessors/12 warnings=3". `where` is one word:
/// blanks and control characters are written as \xNN, an empty one as "-".
std::string result_line(int code, const std::string& id, const std::string& where, size_t warnings);

/// "where: message [id]"; a summary of several errors has neither `where` nor id.
std::string failure_text(const Error& error);

/// Writes a command's result to standard output. A closed pipe is no error: its reader has enough.
///
/// Errors  74 E-OUT-WRITE such as a full disk
Result<void> print_output(const std::string& text);

/// Prints "ERROR where: message [id]", the same for each of error.also, and the result line of the
/// first to standard error; returns the exit code.
///
/// In      counts: further fields of the result line, such as " skipped=3"
int report_failure(const Error& error, const Log& log, const std::string& counts = "");

/// Prints the result line with code 0 unless quiet; returns 0.
int report_success(const std::string& where, const Log& log, const std::string& counts = "");

/// How a signal that stopped a command ends it: "stopped by SIGTERM" with the code 143.
struct StopReason {
    int code = 0;
    std::string text;
};
StopReason stop_reason(int signal);

/// Prints the reason and the result line with code 128 + signal, then lets the signal end the
/// process. After SIGUSR1 the code is 75, and it comes back.
///
/// In      note: what was kept; "": nothing to say
int report_stop(int signal, const std::string& where, const std::string& note, const Log& log);

}  // namespace obscura::app
