// base/atomic_file.cpp - writes files atomically: they appear completely or not at all.
// SPDX-License-Identifier: Apache-2.0
#include "base/atomic_file.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <fcntl.h>
#include <string>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace obscura {

namespace {

namespace fs = std::filesystem;

constexpr mode_t permission_bits = 07777;
constexpr size_t longest_name = 255;  // NAME_MAX of every file system we are likely to meet

std::string reason(int error) {
    return std::generic_category().message(error);
}

tl::unexpected<Error> cannot_create(const fs::path& target, const std::string& why) {
    return fail(ExitCode::cannot_create, "E-OUT-CREATE", target.string(), why);
}

tl::unexpected<Error> cannot_write(const fs::path& target, const char* step, int error) {
    return fail(ExitCode::io_error,
                "E-OUT-WRITE",
                target.string(),
                std::string(step) + ": " + reason(error) + "; an existing file was left as it was");
}

/// Holds back SIGXFSZ in this thread, so that write() past the file size limit returns EFBIG
/// instead of killing the process. Other threads and the process's handlers stay as they are.
class FileSizeSignalBlocked {
public:
    FileSizeSignalBlocked() {
        sigemptyset(&signal_);
        sigaddset(&signal_, SIGXFSZ);
        sigset_t pending;
        sigpending(&pending);
        was_pending_ = sigismember(&pending, SIGXFSZ) == 1;
        pthread_sigmask(SIG_BLOCK, &signal_, &before_);
    }
    ~FileSizeSignalBlocked() {
        const timespec at_once{};
        while (!was_pending_ && sigtimedwait(&signal_, nullptr, &at_once) < 0 && errno == EINTR) {
        }
        pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    }
    FileSizeSignalBlocked(const FileSizeSignalBlocked&) = delete;
    FileSizeSignalBlocked& operator=(const FileSizeSignalBlocked&) = delete;

private:
    sigset_t signal_ = {};
    sigset_t before_ = {};
    bool was_pending_ = false;
};

/// Repeats a call until no signal interrupts it.
template <typename Call>
auto uninterrupted(const Call& call) {
    auto result = call();
    while (result < 0 && errno == EINTR)
        result = call();
    return result;
}

/// An open temporary file that removes itself unless it was renamed.
class TemporaryFile {
public:
    TemporaryFile() = default;
    TemporaryFile(int descriptor, fs::path path)
        : descriptor_(descriptor), path_(std::move(path)) {}
    TemporaryFile(TemporaryFile&& other) noexcept
        : descriptor_(std::exchange(other.descriptor_, -1)),
          path_(std::exchange(other.path_, fs::path())) {}
    TemporaryFile& operator=(TemporaryFile&&) = delete;
    ~TemporaryFile() {
        if (descriptor_ >= 0) ::close(descriptor_);
        if (!path_.empty()) ::unlink(path_.c_str());
    }

    int descriptor() const { return descriptor_; }

    /// 0 or the system's error. The descriptor is gone either way: Linux closes it even when
    /// close() is interrupted.
    int close() {
        const int result = ::close(std::exchange(descriptor_, -1));
        return result == 0 || errno == EINTR ? 0 : errno;
    }

    int rename_to(const fs::path& target) {
        if (::rename(path_.c_str(), target.c_str()) != 0) return errno;
        path_.clear();
        return 0;
    }

private:
    int descriptor_ = -1;
    fs::path path_;
};

/// The target of a symbolic link; the path itself if it is no link, or a dangling one.
fs::path follow_link(const fs::path& target) {
    std::error_code error;
    if (!fs::is_symlink(target, error)) return target;
    fs::path real = fs::canonical(target, error);
    return error ? target : real;
}

/// "<name>.<pid>.<n>.part", never given twice; a long name is cut so that the whole fits.
std::string temporary_name(const fs::path& target) {
    static std::atomic<unsigned> serial{0};
    std::string suffix = ".";
    suffix += std::to_string(::getpid());
    suffix += ".";
    suffix += std::to_string(serial++);
    suffix += ".part";
    std::string name = target.filename().string();
    name.resize(std::min(name.size(), longest_name - suffix.size()));
    return name + suffix;
}

Result<TemporaryFile> create_temporary(const fs::path& target) {
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    if (target.filename().empty() || target.filename() == "." || target.filename() == "..") {
        return cannot_create(target, "this names a folder; give the name of a file in it");
    }
    struct stat existing = {};
    const bool exists = ::stat(target.c_str(), &existing) == 0;
    if (!exists && errno != ENOENT) return cannot_create(target, reason(errno));
    if (exists && !S_ISREG(existing.st_mode)) {
        return cannot_create(target, "exists and is not a regular file; choose another name");
    }
    if (exists && ::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0) {
        return cannot_create(target, "the existing file is write-protected: " + reason(errno));
    }
    for (;;) {
        fs::path path = folder / temporary_name(target);
        const int descriptor = uninterrupted(
            [&] { return ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666); });
        if (descriptor >= 0) {
            TemporaryFile file(descriptor, std::move(path));
            // Best effort: on some file systems only the owner may, and the write still succeeds.
            if (exists && ::fchmod(descriptor, existing.st_mode & permission_bits) != 0) errno = 0;
            return file;
        }
        if (errno == EEXIST) continue;
        if (errno == ENOENT) return cannot_create(target, "there is no folder " + folder.string());
        return cannot_create(target, "cannot create a file there: " + reason(errno));
    }
}

/// Makes the rename durable. File systems that cannot sync folders are not an error.
int sync_folder(const fs::path& target) {
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    const int descriptor =
        uninterrupted([&] { return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); });
    if (descriptor < 0) return 0;
    const int result = uninterrupted([&] { return ::fsync(descriptor); });
    const int error = result == 0 ? 0 : errno;
    ::close(descriptor);
    return error == EIO || error == ENOSPC || error == EDQUOT ? error : 0;
}

}  // namespace

Result<void> write_fully(int descriptor, std::span<const std::byte> bytes, const fs::path& target) {
    constexpr size_t at_once = size_t{1} << 30;  // Linux writes at most 2 GiB - 4 kB in one call
    const FileSizeSignalBlocked blocked;
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), std::min(bytes.size(), at_once));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return cannot_write(target, "writing failed", errno);
        if (written == 0) return cannot_write(target, "writing failed", ENOSPC);
        bytes = bytes.subspan(static_cast<size_t>(written));
    }
    return {};
}

Result<void> write_file_atomically(const fs::path& path, std::span<const std::byte> bytes) {
    return write_pieces_atomically(path, [&](const ByteSink& sink) { return sink(bytes); });
}

Result<void> write_pieces_atomically(const fs::path& path,
                                     const std::function<Result<void>(const ByteSink&)>& produce) {
    const fs::path target = follow_link(path);
    Result<TemporaryFile> file = create_temporary(target);
    if (!file) return fail(std::move(file.error()));
    const auto write = [&](std::span<const std::byte> bytes) {
        return write_fully(file->descriptor(), bytes, target);
    };
    if (auto written = produce(write); !written) return written;
    if (uninterrupted([&] { return ::fsync(file->descriptor()); }) != 0 && errno != EINVAL) {
        return cannot_write(target, "syncing to disk failed", errno);
    }
    if (const int error = file->close()) return cannot_write(target, "closing failed", error);
    if (const int error = file->rename_to(target)) {
        return cannot_write(target, "renaming the finished file failed", error);
    }
    if (const int error = sync_folder(target)) {
        return fail(ExitCode::io_error,
                    "E-OUT-WRITE",
                    target.string(),
                    "the file is complete, but its folder could not be synced: " + reason(error));
    }
    return {};
}

void remove_stale_temporaries(const fs::path& path) {
    constexpr std::chrono::hours min_stale_age{1};
    const fs::path target = follow_link(path);
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    const std::string begin = target.filename().string() + ".";
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
        const std::string name = at->path().filename().string();
        if (name.rfind(begin, 0) != 0) continue;
        int process = 0;
        unsigned serial = 0;
        int length = 0;
        const char* const rest = name.c_str() + begin.size();
        const int found = std::sscanf(rest, "%d.%u.part%n", &process, &serial, &length);
        if (found != 2 || length == 0 || rest[length] != 0 || process <= 0) continue;
        if (::kill(process, 0) == 0 || errno != ESRCH) continue;
        // On a shared file system it may be that of a process of another machine, which writes on.
        std::error_code gone;
        const fs::file_time_type written = fs::last_write_time(at->path(), gone);
        if (gone || fs::file_time_type::clock::now() - written < min_stale_age) continue;
        ::unlink(at->path().c_str());
    }
}

Result<void> check_file_can_be_written(const fs::path& path) {
    const Result<TemporaryFile> file = create_temporary(follow_link(path));
    if (!file) return fail(file.error());
    return {};
}

}  // namespace obscura
