// base/file_bytes.cpp - reads whole regular files into memory; refuses devices and pipes.
// SPDX-License-Identifier: Apache-2.0
#include "base/file_bytes.h"

#include "base/descriptor.h"
#include "base/text.h"

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace obscura {

namespace {

FileBytes failed(FileFault fault, std::string reason) {
    FileBytes out;
    out.fault = fault;
    out.reason = std::move(reason);
    return out;
}

FileBytes failed_from_errno(int code) {
    const std::string reason = std::generic_category().message(code);
    switch (code) {
        case EACCES:
        case EPERM:
            return failed(FileFault::denied, reason);
        case ENXIO:  // a socket, or a device without a driver
        case EISDIR:
            return failed(FileFault::not_a_file, reason);
        case ENOENT:
        case ENOTDIR:
        case ELOOP:
        case ENAMETOOLONG:
            return failed(FileFault::missing, reason);
        default:
            return failed(FileFault::unreadable, reason);
    }
}

}  // namespace

FileBytes read_file_bytes(const std::filesystem::path& path, const ReadLimits& limits) {
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
    if (!file.is_open()) {
        FileBytes failure = failed_from_errno(errno);
        if (is_web_address(path.string())) failure.reason = not_fetched;
        return failure;
    }
    struct stat status = {};
    if (::fstat(file.number(), &status) != 0) return failed_from_errno(errno);
    if (!S_ISREG(status.st_mode)) {
        const char* kind = S_ISDIR(status.st_mode)    ? "it is a folder"
                           : S_ISFIFO(status.st_mode) ? "it is a pipe"
                                                      : "it is a device";
        return failed(FileFault::not_a_file, kind);
    }

    FileBytes out;
    out.size = static_cast<uint64_t>(status.st_size);
    if (out.size > limits.largest_file) {
        out.fault = FileFault::too_large;
        out.reason = std::to_string(out.size) + " bytes, at most " +
                     std::to_string(limits.largest_file) + " are accepted";
        return out;
    }
    const uint64_t wanted = std::min(out.size, limits.first_bytes);
    if (limits.charge) {
        if (auto fits = limits.charge(wanted); !fits) {
            out.fault = FileFault::no_memory;
            out.reason = fits.error().message;
            out.refusal = std::move(fits.error());
            return out;
        }
    }
    out.bytes.resize(wanted);
    size_t done = 0;
    while (done < out.bytes.size()) {
        const ssize_t got = ::read(file.number(), out.bytes.data() + done, out.bytes.size() - done);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return failed_from_errno(errno == EISDIR ? EIO : errno);
        if (got == 0) return failed(FileFault::unreadable, "it became shorter while it was read");
        done += static_cast<size_t>(got);
    }
    return out;
}

}  // namespace obscura
