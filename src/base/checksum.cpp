// base/checksum.cpp - a 64-bit checksum of bytes, against accidents.
// SPDX-License-Identifier: Apache-2.0
#include "base/checksum.h"

#include <algorithm>
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

/// Takes stripes of 32 bytes into the lanes, as many as are whole.
void add_stripes(std::span<const std::byte>& bytes, std::array<uint64_t, 4>& lanes) {
    for (; bytes.size() >= 32; bytes = bytes.subspan(32)) {
        for (size_t i = 0; i < 4; ++i)
            lanes[i] = round_of(lanes[i], word_at<uint64_t>(bytes.data() + 8 * i));
    }
}

uint64_t joined_lanes(const std::array<uint64_t, 4>& lanes) {
    uint64_t hash = std::rotl(lanes[0], 1) + std::rotl(lanes[1], 7) + std::rotl(lanes[2], 12) +
                    std::rotl(lanes[3], 18);
    for (const uint64_t lane : lanes)
        hash = (hash ^ round_of(0, lane)) * prime_1 + prime_4;
    return hash;
}

/// Takes in what is left behind the last stripe.
uint64_t add_rest(std::span<const std::byte> rest, uint64_t hash) {
    const std::byte* at = rest.data();
    const std::byte* const end = at + rest.size();
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

}  // namespace

RunningChecksum::RunningChecksum() : lanes_({prime_1 + prime_2, prime_2, 0, 0 - prime_1}) {}

void RunningChecksum::add(std::span<const std::byte> bytes) {
    size_ += bytes.size();
    if (rest_size_ > 0) {
        const size_t taken = std::min(bytes.size(), stripe - rest_size_);
        std::copy_n(bytes.data(), taken, rest_.data() + rest_size_);
        rest_size_ += taken;
        bytes = bytes.subspan(taken);
        if (rest_size_ < stripe) return;
        std::span<const std::byte> whole = rest_;
        add_stripes(whole, lanes_);
        rest_size_ = 0;
    }
    add_stripes(bytes, lanes_);
    std::copy(bytes.begin(), bytes.end(), rest_.begin());
    rest_size_ = bytes.size();
}

uint64_t RunningChecksum::value() const {
    const uint64_t hash = size_ >= stripe ? joined_lanes(lanes_) : prime_5;
    return add_rest(std::span(rest_).first(rest_size_), hash + size_);
}

uint64_t checksum(std::span<const std::byte> bytes) {
    RunningChecksum out;
    out.add(bytes);
    return out.value();
}

std::string checksum_text(uint64_t checksum) {
    constexpr int digits = 16;
    std::string out(digits, '0');
    for (auto digit = out.rbegin(); digit != out.rend(); ++digit, checksum >>= 4U)
        *digit = "0123456789abcdef"[checksum & 0xFU];
    return out;
}

}  // namespace obscura
