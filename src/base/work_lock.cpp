// base/work_lock.cpp - a file that says who is at work on another.
// SPDX-License-Identifier: Apache-2.0
#include "base/work_lock.h"

#include "base/descriptor.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fcntl.h>
#include <fstream>
#include <mutex>
#include <optional>
#include <sstream>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>
#include <utility>

namespace obscura {

namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds touch_period{5};
constexpr std::chrono::milliseconds settling_time{200};
constexpr mode_t new_file_mode = 0666;

/// Makes a file that must not be there yet.
Descriptor make_file(const fs::path& file) {
    return Descriptor(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, new_file_mode));
}

/// One write of a few bytes; false: they are not all there.
bool write_text(const Descriptor& file, const std::string& text) {
    return ::write(file.number(), text.data(), text.size()) == static_cast<ssize_t>(text.size());
}

double modified_s(const struct stat& status) {
    return static_cast<double>(status.st_mtim.tv_sec) +
           1e-9 * static_cast<double>(status.st_mtim.tv_nsec);
}

/// A lock's file as it is now.
struct FoundLock {
    std::string text;
    double modified_s = 0;
};

/// None: there is no such file any more. Opening it makes a network's file system ask its server.
Result<std::optional<FoundLock>> read_lock(const fs::path& file) {
    const Descriptor opened(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
    if (!opened.is_open() && errno == ENOENT) return std::optional<FoundLock>();
    std::array<char, 4096> bytes = {};
    struct stat status = {};
    const ssize_t size =
        opened.is_open() ? ::read(opened.number(), bytes.data(), bytes.size()) : ssize_t{-1};
    if (size < 0 || ::fstat(opened.number(), &status) != 0) {
        return fail(ExitCode::cannot_create,
                    "E-OUT-CREATE",
                    file.string(),
                    std::string("the lock cannot be read: ") + std::strerror(errno));
    }
    return std::optional(
        FoundLock{std::string(bytes.data(), static_cast<size_t>(size)), modified_s(status)});
}

/// True for a process of this machine that is no more, or that had our own number before us.
bool is_dead(const LockHolder& holder, const LockHolder& us) {
    if (holder.host != us.host || holder.process_space != us.process_space) return false;
    if (holder.process <= 0) return false;
    if (holder.process == us.process) return true;
    return ::kill(static_cast<pid_t>(holder.process), 0) != 0 && errno == ESRCH;
}

std::string described(const LockHolder& holder) {
    if (holder.host.empty()) return "an unknown holder";
    return holder.host + ", process " + std::to_string(holder.process) + ", since " + holder.since;
}

tl::unexpected<Error> cannot_make(const fs::path& file, int error) {
    return fail(ExitCode::cannot_create,
                "E-OUT-CREATE",
                file.string(),
                std::string("the lock cannot be made: ") + std::strerror(error));
}

}  // namespace

struct WorkLock::State {
    State(fs::path name, std::string content, std::string before, Descriptor descriptor)
        : file(std::move(name)),
          text(std::move(content)),
          taken_from(std::move(before)),
          opened(std::move(descriptor)) {}

    const fs::path file;
    const std::string text;
    const std::string taken_from;
    Descriptor opened;
    std::mutex mutex;  ///< of what follows, and of `opened`
    std::condition_variable wake;
    bool is_released = false;
    std::thread toucher;

    /// Touches the file itself, not its name: that may have become another's.
    void keep_touching() {
        std::unique_lock guard(mutex);
        while (!wake.wait_for(guard, touch_period, [this] { return is_released; }))
            ::futimens(opened.number(), nullptr);
    }
};

namespace {

/// A file that is to take a stale lock's place.
struct Claim {
    fs::path file;
    Descriptor opened;
    double now_s = 0;  ///< by the clock of the file system
};

Result<Claim> make_claim(const fs::path& lock, const LockHolder& us, const std::string& text) {
    // Its name does not hold the lock's, which may be as long as names can be.
    const fs::path file =
        lock.parent_path() / (".lock." + us.host + "." + std::to_string(us.process) + ".part");
    ::unlink(file.c_str());  // left by an earlier process of our number
    Claim out{file, make_file(file)};
    struct stat status = {};
    if (!out.opened.is_open() || !write_text(out.opened, text) ||
        ::fstat(out.opened.number(), &status) != 0) {
        const int error = errno;
        ::unlink(file.c_str());
        return cannot_make(file, error);
    }
    out.now_s = modified_s(status);
    return out;
}

/// Replaces a stale lock; null: another was faster.
Result<std::optional<Descriptor>> take_over(const fs::path& lock,
                                            const FoundLock& found,
                                            const std::string& text) {
    const LockHolder us = this_process();
    Result<Claim> claim = make_claim(lock, us, text);
    if (!claim) return fail(claim.error());
    const bool is_stale =
        claim->now_s - found.modified_s > lock_stale_after_s || is_dead(parse_lock(found.text), us);
    if (!is_stale || ::rename(claim->file.c_str(), lock.c_str()) != 0) {
        ::unlink(claim->file.c_str());
        return std::optional<Descriptor>();
    }
    std::this_thread::sleep_for(settling_time);  // others may have found it stale, too
    const Result<std::optional<FoundLock>> after = read_lock(lock);
    if (!after) return fail(after.error());
    if (!*after || (*after)->text != text) return std::optional<Descriptor>();
    return std::optional(std::move(claim->opened));
}

}  // namespace

WorkLock::WorkLock(std::unique_ptr<State> state) : state_(std::move(state)) {
    state_->toucher = std::thread([held = state_.get()] { held->keep_touching(); });
}

WorkLock::~WorkLock() {
    release();
    state_->toucher.join();
}

Result<std::unique_ptr<WorkLock>> WorkLock::take(const fs::path& file) {
    const std::string text = lock_text(this_process());
    const auto hold = [&](Descriptor opened, std::string taken_from) {
        auto state = std::make_unique<State>(file, text, std::move(taken_from), std::move(opened));
        return std::unique_ptr<WorkLock>(new WorkLock(std::move(state)));
    };
    constexpr int max_attempts = 10;  // where others come and go
    for (int i = 0; i < max_attempts; ++i) {
        Descriptor made = make_file(file);
        if (made.is_open()) {
            if (write_text(made, text)) return hold(std::move(made), "");
            const int error = errno;
            ::unlink(file.c_str());
            return cannot_make(file, error);
        }
        if (errno != EEXIST) return cannot_make(file, errno);
        const Result<std::optional<FoundLock>> found = read_lock(file);
        if (!found) return fail(found.error());
        if (!*found) continue;
        Result<std::optional<Descriptor>> taken = take_over(file, **found, text);
        if (!taken) return fail(taken.error());
        if (!*taken) break;
        return hold(std::move(**taken), described(parse_lock((*found)->text)));
    }
    return std::unique_ptr<WorkLock>();
}

void WorkLock::release() {
    {
        const std::lock_guard guard(state_->mutex);
        if (state_->is_released) return;
        state_->is_released = true;
        state_->opened.close();
        const Result<std::optional<FoundLock>> found = read_lock(state_->file);
        const bool is_ours = found && *found && (*found)->text == state_->text;
        if (is_ours) ::unlink(state_->file.c_str());
    }
    state_->wake.notify_all();
}

const std::string& WorkLock::taken_from() const {
    return state_->taken_from;
}

LockHolder parse_lock(const std::string& text) {
    LockHolder out;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const size_t equals = line.find('=');
        if (equals == std::string::npos) continue;
        const std::string name = line.substr(0, equals);
        const std::string value = line.substr(equals + 1);
        if (name == "host") out.host = value;
        if (name == "space") out.process_space = value;
        if (name == "process") out.process = std::strtoll(value.c_str(), nullptr, 10);
        if (name == "since") out.since = value;
    }
    return out;
}

std::string lock_text(const LockHolder& holder) {
    return "host=" + holder.host + "\nspace=" + holder.process_space +
           "\nprocess=" + std::to_string(holder.process) + "\nsince=" + holder.since + "\n";
}

LockHolder this_process() {
    LockHolder out;
    std::array<char, 256> host = {};
    if (::gethostname(host.data(), host.size() - 1) == 0) out.host = host.data();
    std::error_code none;  // not on Linux
    out.process_space = fs::read_symlink("/proc/self/ns/pid", none).string();
    // Machines of one name have the same number of the first space, but were started apart.
    std::string start;
    std::ifstream("/proc/sys/kernel/random/boot_id") >> start;
    out.process_space += " " + start;
    out.process = ::getpid();
    const std::time_t now = std::time(nullptr);
    std::tm utc = {};
    ::gmtime_r(&now, &utc);
    std::array<char, 32> since = {};
    std::strftime(since.data(), since.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
    out.since = since.data();
    return out;
}

}  // namespace obscura
