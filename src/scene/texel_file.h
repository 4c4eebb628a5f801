// scene/texel_file.h - the texels of an image with its mip chain in a file, to be mapped.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace obscura {

/// How many of the textures may be in memory, and where the files are that the others are read from
/// (mapped_texels.h).
struct TextureLimit {
    uint64_t max_bytes = 0;
    std::filesystem::path folder;

    bool operator==(const TextureLimit&) const = default;
};

/// What a file's texels were made from.
struct TexelKey {
    uint64_t image = 0;     ///< checksum of the encoded image
    uint64_t settings = 0;  ///< checksum of all that its texels depend on beside it
    bool operator==(const TexelKey&) const = default;
};

/// The texels begin behind a head of one page, so that they can be mapped.
inline constexpr uint64_t texel_file_head = 4096;

/// "0123456789abcdef-0123456789abcdef.texels": equal images share a file.
std::filesystem::path texel_file(const std::filesystem::path& folder, const TexelKey& key);

/// Whether a file is there, whole, and has so many texels of the key. Its texels are not read.
bool has_texels(const std::filesystem::path& file, const TexelKey& key, size_t texels);

/// Writes a file, whole or not at all. Several processes may write the same one.
///
/// Errors  those of write_file_atomically
Result<void> write_texel_file(const std::filesystem::path& file,
                              const TexelKey& key,
                              std::span<const uint32_t> texels);

}  // namespace obscura
