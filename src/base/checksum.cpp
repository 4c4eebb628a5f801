// base/checksum.cpp - a 64-bit checksum of bytes, against accidents.
// SPDX-License-Identifier: Apache-2.0
#include "base/checksum.h"

#include <array>
#include <bit>
#include <cstring>

namespace obscura {

namespace {

constexpr uint64_t prime_1 = 0x9E3779B185EBCA87ULL;
constexpr uint64_t prime_2 = 0xC2B2AE3D27D4EB4FULL;
constexpr uint64_t prime_3 = 0x165667B19E3779F9ULL;
constexpr uint64_t prime_4 = 0x85EBCA77C2B2AE63ULL;
constexpr uint64_t prime_5 = 0x27D4EB2F165667C5ULL;

static_assert(std::endian::native == std::endian::little);

template <typename T>
uint64_t word_at(const std::byte* bytes) {
    T word;
    std::memcpy(&word, bytes, sizeof(T));
    return word;
}

uint64_t round_of(uint64_t lane, uint64_t word) {
    return std::rotl(lane + word * prime_2, 31) * prime_1;
}

/// The lanes that the stripes of 32 bytes go through, made one.
uint64_t mix_stripes(const std::byte*& at, const std::byte* end) {
    std::array<uint64_t, 4> lanes = {prime_1 + prime_2, prime_2, 0, 0 - prime_1};
    for (; end - at >= 32; at += 32) {
        for (size_t i = 0; i < 4; ++i)
            lanes[i] = round_of(lanes[i], word_at<uint64_t>(at + 8 * i));
    }
    uint64_t hash = std::rotl(lanes[0], 1) + std::rotl(lanes[1], 7) + std::rotl(lanes[2], 12) +
                    std::rotl(lanes[3], 18);
    for (const uint64_t lane : lanes)
        hash = (hash ^ round_of(0, lane)) * prime_1 + prime_4;
    return hash;
}

}  // namespace

uint64_t checksum(std::span<const std::byte> bytes) {
    const std::byte* at = bytes.data();
    const std::byte* const end = at + bytes.size();
    uint64_t hash = bytes.size() >= 32 ? mix_stripes(at, end) : prime_5;
    hash += bytes.size();
    for (; end - at >= 8; at += 8)
        hash = std::rotl(hash ^ round_of(0, word_at<uint64_t>(at)), 27) * prime_1 + prime_4;
    if (end - at >= 4) {
        hash = std::rotl(hash ^ (word_at<uint32_t>(at) * prime_1), 23) * prime_2 + prime_3;
        at += 4;
    }
    for (; at != end; ++at)
        hash = std::rotl(hash ^ (word_at<uint8_t>(at) * prime_5), 11) * prime_1;
    hash = (hash ^ (hash >> 33)) * prime_2;
    hash = (hash ^ (hash >> 29)) * prime_3;
    return hash ^ (hash >> 32);
}

}  // namespace obscura
