// app/outcome.cpp - ends a command: message, result line, exit code.
// SPDX-License-Identifier: Apache-2.0
#include "app/outcome.h"

#include "app/signals.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

namespace obscura::app {

namespace {

/// Settings in messages are named as command line options.
std::string shown(const std::string& text) {
    return escape_control(spell_settings(text, SettingNames::options));
}

std::string one_word(const std::string& text) {
    std::string out;
    for (const char c : shown(text)) {
        if (c == ' ') {
            out += "\\x20";
        } else {
            out += c;
        }
    }
    return out.empty() ? "-" : out;
}

/// Whole lines in one call each, so that they do not mix with other threads' lines.
void print_error_line(const std::string& line) {
    std::fflush(stdout);
    std::fputs((line + "\n").c_str(), stderr);
}

bool ends_by_it(int signal) {
    return signal == SIGINT || signal == SIGTERM;
}

void print_message(const LogMessage& message) {
    const std::string line =
        message.is_warning ? "WARN " + std::string(message.where) + ": " : std::string("INFO ");
    print_error_line(line + std::string(message.text));
}

}  // namespace

TerminalLog::TerminalLog(Verbosity verbosity)
    : Log(verbosity, print_message, SettingNames::options) {}

std::string failure_text(const Error& error) {
    const std::string where = error.where.empty() ? "" : shown(error.where) + ": ";
    const std::string id = error.id.empty() ? "" : " [" + error.id + "]";
    return where + shown(error.message) + id;
}

std::string result_line(int code,
                        const std::string& id,
                        const std::string& where,
                        size_t warnings) {
    return "RESULT code=" + std::to_string(code) + " id=" + one_word(id) +
           " where=" + one_word(where) + " warnings=" + std::to_string(warnings);
}

Result<void> print_output(const std::string& text) {
    const bool written =
        std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
    if (written || errno == EPIPE) return {};
    return fail(ExitCode::io_error, "E-OUT-WRITE", "standard output", std::strerror(errno));
}

int report_failure(const Error& error, const Log& log, const std::string& counts) {
    const int code = static_cast<int>(error.code);
    print_error_line("ERROR " + failure_text(error));
    for (const Error& other : error.also)
        print_error_line("ERROR " + failure_text(other));
    print_error_line(result_line(code, error.id, error.where, log.warnings().size()) + counts);
    return code;
}

int report_success(const std::string& where, const Log& log, const std::string& counts) {
    if (log.verbosity() != Verbosity::quiet) {
        print_error_line(result_line(0, "OK", where, log.warnings().size()) + counts);
    }
    return 0;
}

StopReason stop_reason(int signal) {
    const int code = ends_by_it(signal) ? 128 + signal : static_cast<int>(ExitCode::stopped_early);
    const char* const name = signal == SIGINT    ? "SIGINT"
                             : signal == SIGTERM ? "SIGTERM"
                                                 : "SIGUSR1";
    return {code, std::string("stopped by ") + name};
}

int report_stop(int signal, const std::string& where, const std::string& note, const Log& log) {
    const StopReason reason = stop_reason(signal);
    print_error_line("ERROR " + escape_control(where) + ": " + reason.text +
                     "; no further output was written and existing files are as they were" +
                     (note.empty() ? "" : "; " + escape_control(note)));
    print_error_line(result_line(reason.code, "E-STOPPED", where, log.warnings().size()));
    std::fflush(nullptr);
    if (ends_by_it(signal)) end_by_signal(signal);
    return reason.code;
}

}  // namespace obscura::app
