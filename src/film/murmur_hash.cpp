// film/murmur_hash.cpp - MurmurHash3 of byte strings, the hash that Cryptomatte names have.
// SPDX-License-Identifier: Apache-2.0
#include "film/murmur_hash.h"

#include <bit>

namespace obscura {

namespace {

constexpr size_t block_bytes = 4;

/// Up to four bytes as a number, the first one lowest.
uint32_t little_endian(std::string_view bytes) noexcept {
    uint32_t out = 0;
    for (size_t i = 0; i < bytes.size(); ++i)
        out |= uint32_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
    return out;
}

/// Spreads the bits of a block before it joins the hash; 0 stays 0.
uint32_t scrambled(uint32_t block) noexcept {
    return std::rotl(block * 0xcc9e2d51u, 15) * 0x1b873593u;
}

/// Lets every bit of the hash depend on every other.
uint32_t avalanched(uint32_t hash) noexcept {
    hash = (hash ^ (hash >> 16)) * 0x85ebca6bu;
    hash = (hash ^ (hash >> 13)) * 0xc2b2ae35u;
    return hash ^ (hash >> 16);
}

}  // namespace

uint32_t murmur_hash(std::string_view bytes, uint32_t seed) noexcept {
    uint32_t hash = seed;
    std::string_view rest = bytes;
    for (; rest.size() >= block_bytes; rest.remove_prefix(block_bytes)) {
        hash ^= scrambled(little_endian(rest.substr(0, block_bytes)));
        hash = std::rotl(hash, 13) * 5u + 0xe6546b64u;
    }
    hash ^= scrambled(little_endian(rest));
    return avalanched(hash ^ static_cast<uint32_t>(bytes.size()));
}

}  // namespace obscura
