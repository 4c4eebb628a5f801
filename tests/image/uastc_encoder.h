// tests/image/uastc_encoder.h - UASTC by its printed tables, independently: blocks and texels.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/bit_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace obscura::testing_images {

struct UastcModeEntry {
    std::string_view code;  ///< lowest bit last
    int hint_bits;
    size_t colors;  ///< channels of an endpoint: 2 is luminance and alpha
    size_t subsets;
    int planes;
    int base;  ///< 3: trits, 5: quints, 1: plain bits
    int bits;
    int weight_bits;
    size_t patterns;  ///< how many there are
};

constexpr size_t uastc_solid_mode = 8;
constexpr std::array<UastcModeEntry, 19> uastc_mode_entries = {
    {{"0001", 15, 3, 1, 1, 3, 6, 4, 1},
     {"110101", 15, 3, 1, 1, 1, 8, 2, 1},
     {"11101", 15, 3, 2, 1, 1, 4, 3, 30},
     {"00011", 15, 3, 3, 1, 3, 2, 2, 11},
     {"10011", 15, 3, 2, 1, 5, 3, 2, 30},
     {"01011", 15, 3, 1, 1, 1, 8, 3, 1},
     {"11011", 15, 3, 1, 2, 5, 5, 2, 1},
     {"00111", 15, 3, 2, 1, 5, 3, 2, 19},
     {"10111", 0, 4, 1, 1, 1, 8, 0, 1},
     {"01111", 23, 4, 2, 1, 1, 4, 2, 30},
     {"010", 17, 4, 1, 1, 3, 4, 4, 1},
     {"00", 17, 4, 1, 2, 3, 4, 2, 1},
     {"110", 17, 4, 1, 1, 3, 6, 3, 1},
     {"11111", 23, 4, 1, 2, 1, 8, 1, 1},
     {"01101", 23, 4, 1, 1, 1, 8, 2, 1},
     {"0000101", 23, 2, 1, 1, 1, 8, 4, 1},
     {"010101", 23, 2, 2, 1, 1, 8, 2, 30},
     {"100101", 23, 2, 1, 2, 1, 8, 2, 1},
     {"1001", 15, 3, 1, 1, 1, 5, 5, 1}}};

/// Texels of the second subset as bits, the first texel lowest: modes 2, 4, 9, 16.
constexpr std::array<uint16_t, 30> uastc_masks_two = {
    0xCCCC, 0x8888, 0x1111, 0xECC8, 0x377F, 0xFEEC, 0x0137, 0x137F, 0xC800, 0x0013,
    0xFE80, 0x17FF, 0x0017, 0x00FF, 0xFFF0, 0x0FFF, 0xFF71, 0x8EFF, 0x08CE, 0x008C,
    0x7310, 0xCEFF, 0x7331, 0x088C, 0xCEEF, 0x6666, 0xF00F, 0x5555, 0x0F0F, 0x36C9};
constexpr std::array<uint16_t, 19> uastc_masks_two_of_mode_7 = {0x00F0,
                                                                0x4444,
                                                                0x0133,
                                                                0xCC80,
                                                                0xF0FF,
                                                                0x2222,
                                                                0xFFC8,
                                                                0xCCCE,
                                                                0x3C03,
                                                                0x00EE,
                                                                0x7700,
                                                                0x3003,
                                                                0x00CE,
                                                                0xFF80,
                                                                0x6FFF,
                                                                0x1333,
                                                                0x11FF,
                                                                0x136C,
                                                                0x00EF};
/// Of the second (lower half) and the third subset: mode 3.
constexpr std::array<uint32_t, 11> uastc_masks_three = {0xCC003300,
                                                        0xF00000FF,
                                                        0xF000000F,
                                                        0x00F0000F,
                                                        0x44443333,
                                                        0x88886666,
                                                        0x2222CCCC,
                                                        0x1111EE00,
                                                        0x99994444,
                                                        0x0F00F00F,
                                                        0xC00C0CC0};

inline size_t uastc_subset(size_t mode, size_t pattern, size_t texel) {
    if (mode == 3) {
        const uint32_t mask = uastc_masks_three[pattern] >> texel;
        return (mask & 1U) != 0 ? 1 : (mask >> 16 & 1U) != 0 ? 2 : 0;
    }
    if (uastc_mode_entries[mode].subsets == 1) return 0;
    const uint32_t mask = mode == 7 ? uastc_masks_two_of_mode_7[pattern] : uastc_masks_two[pattern];
    return mask >> texel & 1U;
}

/// The contents of a block before it is packed.
struct UastcNumbers {
    size_t mode = 0;
    size_t pattern = 0;
    size_t apart = 3;                                      ///< the channel with its own weights
    std::vector<uint32_t> digits = {};                     ///< trits or quints of the endpoints
    std::vector<uint32_t> low_bits = {};                   ///< the endpoints' other bits
    std::array<std::array<uint32_t, 2>, 16> weights = {};  ///< by texel and plane
};

/// Whether a texel is the first of its subset, whose weights lack their upper bit.
inline bool uastc_is_anchor(const UastcNumbers& numbers, size_t texel) {
    const size_t subset = uastc_subset(numbers.mode, numbers.pattern, texel);
    for (size_t i = 0; i < texel; ++i) {
        if (uastc_subset(numbers.mode, numbers.pattern, i) == subset) return false;
    }
    return true;
}

inline std::vector<std::byte> uastc_block(const UastcNumbers& numbers) {
    const UastcModeEntry& entry = uastc_mode_entries[numbers.mode];
    BitWriter out;
    out.put_code(std::string(entry.code.rbegin(), entry.code.rend()));
    out.put(0x5A5A5A, entry.hint_bits);
    if (entry.patterns > 1) out.put(numbers.pattern, numbers.mode == 3 ? 4 : 5);
    if (entry.planes == 2 && entry.colors > 2) out.put(numbers.apart, 2);
    const size_t group = entry.base == 3 ? 5 : 3;
    for (size_t first = 0; entry.base > 1 && first < numbers.digits.size(); first += group) {
        const size_t count = std::min(group, numbers.digits.size() - first);
        uint64_t packed = 0, combinations = 1;
        for (size_t i = 0; i < count; ++i) {
            packed += combinations * numbers.digits[first + i];
            combinations *= static_cast<uint64_t>(entry.base);
        }
        out.put(packed, static_cast<int>(std::ceil(std::log2(combinations))));
    }
    for (const uint32_t low : numbers.low_bits)
        out.put(low, entry.bits);
    for (size_t i = 0; i < 16; ++i) {
        for (size_t plane = 0; plane < static_cast<size_t>(entry.planes); ++plane) {
            const int stored = entry.weight_bits - (uastc_is_anchor(numbers, i) ? 1 : 0);
            out.put(numbers.weights[i][plane], stored);
        }
    }
    std::vector<std::byte> bytes = out.bytes();
    bytes.resize(16);
    return bytes;
}

/// An endpoint on 0..255, by the bit patterns of ASTC's table: a is the lowest stored bit.
inline uint32_t astc_endpoint(const UastcModeEntry& entry, uint32_t digit, uint32_t low) {
    struct Parameters {
        int base;
        int bits;
        std::string_view b;
        uint32_t c;
    };
    static constexpr Parameters table[] = {{3, 2, "b000b0bb0", 93},
                                           {5, 3, "cb0000cbc", 26},
                                           {3, 4, "dcb000dcb", 22},
                                           {5, 5, "edcb0000e", 6},
                                           {3, 6, "fedcb000f", 5},
                                           {1, 4, "dcbadcba", 0},
                                           {1, 5, "edcbaedc", 0},
                                           {1, 8, "hgfedcba", 0}};
    for (const Parameters& parameters : table) {
        if (parameters.base != entry.base || parameters.bits != entry.bits) continue;
        uint32_t b = 0;
        for (const char bit : parameters.b)
            b = b << 1 | (bit == '0' ? 0 : low >> (bit - 'a') & 1U);
        if (entry.base == 1) return b;
        const uint32_t a = (low & 1U) != 0 ? 0x1FF : 0;
        return (a & 0x80U) | (((digit * parameters.c + b) ^ a) >> 2);
    }
    return 0;
}

/// Weights on 0..64 as ASTC's rules make them, by bits.
inline double astc_weight(int bits, uint32_t stored) {
    static const std::vector<std::vector<int>> table = {
        {},
        {0, 64},
        {0, 21, 43, 64},
        {0, 9, 18, 27, 37, 46, 55, 64},
        {0, 4, 8, 12, 17, 21, 25, 29, 35, 39, 43, 47, 52, 56, 60, 64},
        {0,  2,  4,  6,  8,  10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30,
         34, 36, 38, 40, 42, 44, 46, 48, 50, 52, 54, 56, 58, 60, 62, 64}};
    return table[static_cast<size_t>(bits)][stored];
}

/// One channel of one texel, by ASTC's formula in double.
inline uint32_t uastc_expected(const UastcNumbers& numbers,
                               size_t texel,
                               size_t channel,
                               bool srgb) {
    const UastcModeEntry& entry = uastc_mode_entries[numbers.mode];
    const size_t stored = entry.colors > 2 ? channel : channel / 3;  // luminance, alpha
    if (stored >= entry.colors) return 255;
    const size_t subset = uastc_subset(numbers.mode, numbers.pattern, texel);
    const size_t at = 2 * (subset * entry.colors + stored);
    double ends[2];
    for (size_t i = 0; i < 2; ++i) {
        const uint32_t digit = entry.base > 1 ? numbers.digits[at + i] : 0;
        const double end = astc_endpoint(entry, digit, numbers.low_bits[at + i]);
        ends[i] = srgb && channel < 3 ? 256 * end + 128 : 257 * end;
    }
    const size_t plane = entry.planes == 2 && channel == numbers.apart ? 1 : 0;
    const double weight = astc_weight(entry.weight_bits, numbers.weights[texel][plane]);
    const double mixed = std::floor((ends[0] * (64 - weight) + ends[1] * weight + 32) / 64);
    return static_cast<uint32_t>(mixed / 256);
}

}  // namespace obscura::testing_images
