// tests/image/texel_hash.h - a hash of many texels, to compare with another program's.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace obscura::testing_images {

/// FNV-1a in 64 bits over the bytes of texels, R first; `seed`: the hash of those before.
inline uint64_t texel_hash(std::span<const uint32_t> texels,
                           uint64_t seed = 0xCBF29CE484222325ULL) {
    uint64_t hash = seed;
    for (const uint32_t texel : texels) {
        for (int shift = 0; shift < 32; shift += 8)
            hash = (hash ^ (texel >> shift & 0xFFU)) * 0x100000001B3ULL;
    }
    return hash;
}

}  // namespace obscura::testing_images
