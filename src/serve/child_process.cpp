// serve/child_process.cpp - a program that runs beside the server.
// SPDX-License-Identifier: Apache-2.0
#include "serve/child_process.h"

#include <array>
#include <csignal>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace obscura::serve {

namespace {

constexpr int signal_base = 128;  // as shells say it

/// Where a child has its end of the pipe between its server and it.
constexpr int lifeline_number = STDERR_FILENO + 1;

/// What a child is to find when it begins.
class SpawnPlan {
public:
    SpawnPlan(const ChildSetup& setup, const Descriptor& end_of_pipe) {
        constexpr int flags = O_WRONLY | O_CREAT | O_TRUNC, mode = 0600;
        posix_spawn_file_actions_init(&actions_);
        posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, setup.out.c_str(), flags, mode);
        if (setup.err == setup.out) {
            posix_spawn_file_actions_adddup2(&actions_, STDOUT_FILENO, STDERR_FILENO);
        } else {
            posix_spawn_file_actions_addopen(
                &actions_, STDERR_FILENO, setup.err.c_str(), flags, mode);
        }
        posix_spawn_file_actions_adddup2(&actions_, end_of_pipe.number(), lifeline_number);
        // The HTTP library's sockets stay open across exec: a port would stay taken.
        posix_spawn_file_actions_addclosefrom_np(&actions_, lifeline_number + 1);
        posix_spawn_file_actions_addchdir_np(&actions_, setup.folder.c_str());
        posix_spawnattr_init(&attributes_);
        posix_spawnattr_setpgroup(&attributes_, 0);
        sigset_t none, broken_pipes;
        sigemptyset(&none);
        sigemptyset(&broken_pipes);
        sigaddset(&broken_pipes, SIGPIPE);  // which the server ignores
        posix_spawnattr_setsigmask(&attributes_, &none);
        posix_spawnattr_setsigdefault(&attributes_, &broken_pipes);
        posix_spawnattr_setflags(&attributes_,
                                 static_cast<short>(POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK |
                                                    POSIX_SPAWN_SETSIGDEF));
    }
    ~SpawnPlan() {
        posix_spawn_file_actions_destroy(&actions_);
        posix_spawnattr_destroy(&attributes_);
    }
    SpawnPlan(const SpawnPlan&) = delete;
    SpawnPlan& operator=(const SpawnPlan&) = delete;

    const posix_spawn_file_actions_t* actions() const { return &actions_; }
    const posix_spawnattr_t* attributes() const { return &attributes_; }

private:
    posix_spawn_file_actions_t actions_ = {};
    posix_spawnattr_t attributes_ = {};
};

/// A pipe whose closing is told to a process group, by SIGTERM.
struct Lifeline {
    Descriptor of_child, own;

    /// Errors  errno
    static std::optional<Lifeline> open() {
        int ends[2];
        if (::pipe2(ends, O_CLOEXEC) != 0) return {};
        Descriptor low(ends[0]);
        Lifeline out{Descriptor(::fcntl(low.number(), F_DUPFD_CLOEXEC, lifeline_number)),
                     Descriptor(ends[1])};
        if (!out.of_child.is_open()) return {};
        const int end = out.of_child.number();
        if (::fcntl(end, F_SETSIG, SIGTERM) != 0 || ::fcntl(end, F_SETFL, O_ASYNC) != 0) return {};
        return out;
    }
    void tell(pid_t group) const { ::fcntl(of_child.number(), F_SETOWN, -group); }
};

Error cannot_be_run(const std::string& program, int failure) {
    return {ExitCode::io_error,
            "E-JOB-START",
            program,
            "cannot be run: " + std::generic_category().message(failure)};
}

}  // namespace

Result<ChildProcess> ChildProcess::start(const ChildSetup& setup) {
    std::optional<Lifeline> pipe = Lifeline::open();
    if (!pipe) return fail(cannot_be_run(setup.words.front(), errno));
    const SpawnPlan plan(setup, pipe->of_child);
    std::vector<std::string> words = setup.words;
    std::vector<char*> pointers;
    for (std::string& word : words)
        pointers.push_back(word.data());
    pointers.push_back(nullptr);
    pid_t process = 0;
    const int failure = ::posix_spawn(
        &process, pointers.front(), plan.actions(), plan.attributes(), pointers.data(), environ);
    if (failure != 0) return fail(cannot_be_run(words.front(), failure));
    pipe->tell(process);
    return ChildProcess(process, std::move(pipe->own));
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : process_(std::exchange(other.process_, 0)),
      pipe_(std::move(other.pipe_)),
      code_(other.code_) {}

ChildProcess::~ChildProcess() {
    if (process_ == 0 || code_) return;
    send(SIGKILL);
    while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
}

std::optional<int> ChildProcess::code() {
    if (process_ == 0 || code_) return code_;
    siginfo_t ended = {};
    constexpr int options = WEXITED | WNOHANG | WNOWAIT;
    const int failure = ::waitid(P_PID, static_cast<id_t>(process_), &ended, options);
    if (failure == 0 && ended.si_pid == 0) return {};
    // Before its number is free for others: what it started ends with it.
    ::kill(-process_, SIGKILL);
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    code_ = WIFSIGNALED(status) ? signal_base + WTERMSIG(status) : WEXITSTATUS(status);
    return code_;
}

void ChildProcess::send(int signal) const {
    if (process_ != 0 && !code_) ::kill(-process_, signal);
}

}  // namespace obscura::serve
