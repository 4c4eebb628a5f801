// base/sha256.h - SHA-256 of files and of bytes in memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace obscura {

/// A file's SHA-256 and size.
struct FileDigest {
    std::string sha256;  ///< 64 hexadecimal digits, in lower case
    uint64_t bytes = 0;
};

/// Nothing: the file cannot be read.
std::optional<FileDigest> digest_file(const std::filesystem::path& file);

/// 64 hexadecimal digits, in lower case; "": OpenSSL has no SHA-256.
std::string sha256_of(std::span<const std::byte> bytes);

}  // namespace obscura
