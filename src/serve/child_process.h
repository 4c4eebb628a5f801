// serve/child_process.h - a program that runs beside the server, in a process group of its own.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/descriptor.h"
#include "base/error.h"

#include <filesystem>
#include <optional>
#include <string>
#include <sys/types.h>
#include <utility>
#include <vector>

namespace obscura::serve {

struct ChildSetup {
    std::vector<std::string> words;  ///< the program, by its path, first
    std::filesystem::path folder;    ///< where it runs
    std::filesystem::path out, err;  ///< files that get what it prints; may be one file
};

/// A running program, with all that it starts itself. One thread at a time may use it.
class ChildProcess {
public:
    /// It reads nothing, and has none of the server's files and sockets. When this program ends
    /// without waiting for it, killed for example, the system sends it SIGTERM.
    ///
    /// Errors  74 E-JOB-START the program cannot be run
    static Result<ChildProcess> start(const ChildSetup& setup);
    /// What still runs is killed.
    ~ChildProcess();
    ChildProcess(ChildProcess&& other) noexcept;
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    /// Its exit code, 128 + signal where a signal ended it; nothing while it runs.
    std::optional<int> code();
    /// Sends a signal to it and to what it started; of no effect after its end.
    void send(int signal) const;

private:
    ChildProcess(pid_t process, Descriptor pipe) : process_(process), pipe_(std::move(pipe)) {}

    pid_t process_ = 0;  ///< 0: moved away
    Descriptor pipe_;    ///< the end whose closing ends it
    std::optional<int> code_;
};

}  // namespace obscura::serve
