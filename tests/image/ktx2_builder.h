// tests/image/ktx2_builder.h - KTX2 files field by field, whole or wrong.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/png_builder.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace obscura::testing_images {

inline void append_little_endian(ByteVector& out, uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i, value >>= 8)
        append(out, {static_cast<unsigned>(value & 0xFF)});
}

/// A file's contents; the defaults are one opaque texel of R8G8B8A8_UNORM without levels.
struct Ktx2Parts {
    uint32_t format = 37;
    uint32_t width = 1;
    uint32_t height = 1;
    uint32_t depth = 0;
    uint32_t layers = 0;
    uint32_t faces = 1;
    uint32_t scheme = 0;
    uint32_t model = 1;
    uint32_t primaries = 1;
    uint32_t transfer = 1;
    uint32_t flags = 0;
    std::vector<uint32_t> channels = {0, 1, 2, 15};
    std::vector<std::pair<std::string, std::string>> key_values = {};
    std::vector<ByteVector> levels = {};
    std::optional<uint64_t> uncompressed_bytes = {};  ///< of every level; else as stored
    std::optional<uint32_t> level_count = {};         ///< else as many as there are
    ByteVector global = {};
};

inline ByteVector ktx2_description(const Ktx2Parts& parts) {
    ByteVector out;
    const uint32_t block = 24 + 16 * static_cast<uint32_t>(parts.channels.size());
    append_little_endian(out, block + 4, 4);
    append_little_endian(out, 0, 4);                // vendor, type: Khronos, basic
    append_little_endian(out, 2 | block << 16, 4);  // version
    append(out, {parts.model, parts.primaries, parts.transfer, parts.flags});
    append_little_endian(out, 0, 4);   // block size: not looked at
    append_little_endian(out, 16, 8);  // bytes of planes: nor these
    for (const uint32_t channel : parts.channels) {
        append_little_endian(out, (7U << 16) | channel << 24, 4);
        append_little_endian(out, 0, 8);
        append_little_endian(out, 0xFF, 4);
    }
    return out;
}

inline ByteVector ktx2_key_values(const Ktx2Parts& parts) {
    ByteVector out;
    for (const auto& [key, value] : parts.key_values) {
        append_little_endian(out, key.size() + value.size() + 2, 4);
        append_text(out, key + '\0' + value + '\0');
        while (out.size() % 4 != 0)
            append(out, {0});
    }
    return out;
}

/// Header, index, description, key/value data, global data, levels from the last to the first.
inline ByteVector ktx2_file(const Ktx2Parts& parts) {
    const ByteVector description = ktx2_description(parts);
    const ByteVector key_values = ktx2_key_values(parts);
    const auto levels = static_cast<uint32_t>(parts.levels.size());
    uint64_t at = 80 + 24 * levels;
    ByteVector out;
    append_text(out, std::string_view("\xABKTX 20\xBB\r\n\x1A\n", 12));
    for (const uint32_t field : {parts.format,
                                 1U,
                                 parts.width,
                                 parts.height,
                                 parts.depth,
                                 parts.layers,
                                 parts.faces,
                                 parts.level_count.value_or(levels),
                                 parts.scheme}) {
        append_little_endian(out, field, 4);
    }
    append_little_endian(out, at, 4);
    append_little_endian(out, description.size(), 4);
    append_little_endian(out, at += description.size(), 4);
    append_little_endian(out, key_values.size(), 4);
    append_little_endian(out, at += key_values.size(), 8);
    append_little_endian(out, parts.global.size(), 8);
    at += parts.global.size();
    for (const ByteVector& level : parts.levels)
        at += level.size();
    for (const ByteVector& level : parts.levels) {
        append_little_endian(out, at -= level.size(), 8);
        append_little_endian(out, level.size(), 8);
        append_little_endian(out, parts.uncompressed_bytes.value_or(level.size()), 8);
    }
    for (const ByteVector* part : {&description, &key_values, &parts.global})
        out.insert(out.end(), part->begin(), part->end());
    for (auto level = parts.levels.rbegin(); level != parts.levels.rend(); ++level)
        out.insert(out.end(), level->begin(), level->end());
    return out;
}

}  // namespace obscura::testing_images
