// base/atomic_file.h - writes files atomically: they appear completely or not at all.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>

namespace obscura {

/// Replaces `target` by `bytes`: a temporary file "<name>.<pid>.<n>.part" beside it is written,
/// synced and renamed, then the folder is synced. After a failure the temporary file is gone and
/// an existing target is as it was. A symbolic link is followed, so that its target is replaced.
/// An existing file's permissions are kept.
///
/// Errors  73 E-OUT-CREATE the folder is missing or not writable, the name is too long, the
///         target is a folder, a device or a write-protected file;
///         74 E-OUT-WRITE disk full, quota, file size limit, I/O error
Result<void> write_file_atomically(const std::filesystem::path& target,
                                   std::span<const std::byte> bytes);

/// Takes the next bytes of a file. The bytes may be gone afterwards.
using ByteSink = std::function<Result<void>(std::span<const std::byte>)>;

/// The same for a file that is made piece by piece, so that memory need not hold all of it.
///
/// In      produce: hands all pieces to the sink, in order, and ends with the first error
Result<void> write_pieces_atomically(const std::filesystem::path& target,
                                     const std::function<Result<void>(const ByteSink&)>& produce);

/// Removes temporary files of `target` that nobody has written to for an hour and whose process is
/// no more. Both, as the process may live on another machine with the same file system.
void remove_stale_temporaries(const std::filesystem::path& target);

/// Checks that write_file_atomically(target, ...) can start, by creating and removing its temporary
/// file. Changes nothing else. Same errors.
Result<void> check_file_can_be_written(const std::filesystem::path& target);

/// Writes all bytes to an open descriptor: continues after interruptions and short writes, and
/// turns the file size limit's signal (SIGXFSZ) into an error.
///
/// Errors  74 E-OUT-WRITE with the system's reason
Result<void> write_fully(int descriptor,
                         std::span<const std::byte> bytes,
                         const std::filesystem::path& target);

}  // namespace obscura
