// base/file_bytes.h - reads whole regular files into memory; refuses devices and pipes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace obscura {

using Bytes = std::vector<std::byte>;

enum class FileFault { none, missing, denied, not_a_file, too_large, no_memory, unreadable };

struct FileBytes {
    FileFault fault = FileFault::none;
    std::string reason;  ///< the system's words, when fault is not none
    uint64_t size = 0;   ///< of the file; `bytes` may hold less
    Bytes bytes;
    std::optional<Error> refusal = {};  ///< of ReadLimits::charge, when fault is no_memory
};

struct ReadLimits {
    uint64_t largest_file = UINT64_MAX;  ///< larger ones are refused (too_large)
    uint64_t first_bytes = UINT64_MAX;   ///< only this many are read
    /// Asked with the number of bytes to be read, before there is memory for them; may refuse
    std::function<Result<void>(uint64_t)> charge = {};
};

/// Reads a regular file. A FIFO, a socket or a device is refused without waiting for it.
FileBytes read_file_bytes(const std::filesystem::path& path, const ReadLimits& limits);

}  // namespace obscura
