// base/rescued_file.h - writes what took long to make: again when it fails, at last somewhere else.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <span>

namespace obscura {

/// What is done for a file that cannot be written.
struct WriteRescue {
    int retries = 0;                          ///< --write-retries
    double first_wait_s = 1;                  ///< before the first retry; then twice as long each
    const std::atomic<bool>* stop = nullptr;  ///< no retries any more once it is true
};

/// Writes a file as write_file_atomically does, whose target could be created before the work
/// began. When that fails in the end, a copy is left in the folder for temporary files ($TMPDIR),
/// named as the file with the process's number, and the message says where.
///
/// Errors  74 E-OUT-WRITE
Result<void> write_or_rescue(const std::filesystem::path& path,
                             std::span<const std::byte> bytes,
                             const WriteRescue& rescue);

}  // namespace obscura
