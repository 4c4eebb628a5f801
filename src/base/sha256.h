// base/sha256.h - SHA-256 of files.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace obscura {

/// A file's SHA-256 and size.
struct FileDigest {
    std::string sha256;  ///< 64 hexadecimal digits, in lower case
    uint64_t bytes = 0;
};

/// Nothing: the file cannot be read.
std::optional<FileDigest> digest_file(const std::filesystem::path& file);

}  // namespace obscura
