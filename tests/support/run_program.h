// tests/support/run_program.h - runs a program as a shell would and keeps what it prints.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <functional>
#include <poll.h>
#include <stdexcept>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace obscura {

struct ProgramRun {
    int code = -1;   ///< exit code; 128 + signal where a signal ended it, as a shell says
    int signal = 0;  ///< that signal, 0 otherwise
    std::string out;
    std::string err;
};

struct ProgramSetup {
    std::vector<std::string> arguments;  ///< the program first
    std::filesystem::path folder = std::filesystem::current_path();
    std::vector<std::string> environment;  ///< "NAME=value", added to ours
    std::function<void()> before_start;    ///< in the child: limits and the like
    /// Called with the process and all standard output so far, whenever more comes.
    std::function<void(const std::string&, pid_t)> on_output;
    double time_limit_s = 120;
};

namespace run_program_detail {

[[noreturn]] inline void become(const ProgramSetup& setup, int out, int err) {
    dup2(out, STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    const int nothing = open("/dev/null", O_RDONLY);
    dup2(nothing, STDIN_FILENO);
    for (const std::string& variable : setup.environment) {
        const size_t equals = variable.find('=');
        setenv(variable.substr(0, equals).c_str(), variable.substr(equals + 1).c_str(), 1);
    }
    if (chdir(setup.folder.c_str()) != 0) _exit(126);
    if (setup.before_start) setup.before_start();
    std::vector<char*> argv;
    for (const std::string& argument : setup.arguments) {
        argv.push_back(const_cast<char*>(argument.c_str()));
    }
    argv.push_back(nullptr);
    execv(argv[0], argv.data());
    _exit(127);
}

/// Reads available output; closes the descriptor and sets it to -1 at its end.
inline bool drain(int& descriptor, std::string& text) {
    char buffer[4096];
    const ssize_t count = read(descriptor, buffer, sizeof buffer);
    if (count > 0) {
        text.append(buffer, static_cast<size_t>(count));
        return true;
    }
    if (count == 0 || errno != EINTR) {
        close(descriptor);
        descriptor = -1;
    }
    return false;
}

inline void collect(const ProgramSetup& setup, pid_t child, int out, int err, ProgramRun& run) {
    const auto end =
        std::chrono::steady_clock::now() + std::chrono::duration<double>(setup.time_limit_s);
    while (out >= 0 || err >= 0) {
        pollfd files[2] = {{out, POLLIN, 0}, {err, POLLIN, 0}};
        poll(files, 2, 100);
        if (out >= 0 && files[0].revents != 0 && drain(out, run.out) && setup.on_output) {
            setup.on_output(run.out, child);
        }
        if (err >= 0 && files[1].revents != 0) drain(err, run.err);
        if (std::chrono::steady_clock::now() > end) kill(child, SIGKILL);
    }
}

}  // namespace run_program_detail

/// Runs to the end; a program that takes longer than the limit is killed (code 137).
inline ProgramRun run_program_with(const ProgramSetup& setup) {
    int out[2];
    int err[2];
    if (pipe2(out, O_CLOEXEC) != 0 || pipe2(err, O_CLOEXEC) != 0) {
        throw std::runtime_error("no pipe");
    }
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("no process");
    if (child == 0) run_program_detail::become(setup, out[1], err[1]);
    close(out[1]);
    close(err[1]);
    ProgramRun run;
    run_program_detail::collect(setup, child, out[0], err[0], run);
    int status = 0;
    waitpid(child, &status, 0);
    run.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    run.code = run.signal != 0 ? 128 + run.signal : WEXITSTATUS(status);
    return run;
}

inline std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    size_t begin = 0;
    while (begin < text.size()) {
        const size_t end = std::min(text.find('\n', begin), text.size());
        lines.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return lines;
}

}  // namespace obscura
