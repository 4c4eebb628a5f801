// base/rescued_file.cpp - writes what took long to make: again when it fails, at last elsewhere.
// SPDX-License-Identifier: Apache-2.0
#include "base/rescued_file.h"

#include "base/atomic_file.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <system_error>
#include <thread>
#include <unistd.h>

namespace obscura {

namespace {

namespace fs = std::filesystem;

bool is_stopped(const WriteRescue& rescue) {
    return rescue.stop != nullptr && *rescue.stop;
}

void wait(double seconds, const WriteRescue& rescue) {
    constexpr double step_s = 0.05;
    for (double left = seconds; left > 0 && !is_stopped(rescue); left -= step_s)
        std::this_thread::sleep_for(std::chrono::duration<double>(std::min(left, step_s)));
}

/// "<folder for temporary files>/shot.1234.exr"; empty: there is no such folder, or it is where the
/// file was to be.
fs::path copy_of(const fs::path& path) {
    std::error_code error;
    const fs::path folder = fs::temp_directory_path(error);
    if (error) return {};
    const fs::path own = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (fs::equivalent(folder, own, error)) return {};
    const std::string number = "." + std::to_string(::getpid());
    return folder / (path.stem().string() + number + path.extension().string());
}

/// Leaves the copy. Returns what to say of it.
std::string leave_copy(const fs::path& copy, std::span<const std::byte> bytes) {
    if (copy.empty()) return "; there is no other folder for a copy: set TMPDIR";
    if (auto written = write_file_atomically(copy, bytes); !written)
        return "; a copy could not be written either, as " + copy.string() + ": " +
               written.error().message;
    return "; a copy is " + copy.string();
}

}  // namespace

Result<void> write_or_rescue(const fs::path& path,
                             std::span<const std::byte> bytes,
                             const WriteRescue& rescue) {
    Result<void> written = write_file_atomically(path, bytes);
    double wait_s = rescue.first_wait_s;
    for (int k = 0; !written && k < rescue.retries && !is_stopped(rescue); ++k) {
        wait(wait_s, rescue);
        wait_s *= 2;
        written = write_file_atomically(path, bytes);
    }
    if (written) return {};
    Error error = written.error();
    error.code = ExitCode::io_error;
    error.id = "E-OUT-WRITE";
    error.message += leave_copy(copy_of(path), bytes);
    return fail(error);
}

}  // namespace obscura
