// image/uastc_patterns.cpp - computes UASTC's partition patterns from ASTC's partition function.
// SPDX-License-Identifier: Apache-2.0
#include "image/uastc_patterns.h"

#include <span>

namespace obscura {

namespace {

/// Source  Khronos Data Format 1.4, ASTC, "Partition Pattern Generation"
constexpr uint32_t hash52(uint32_t p) {
    p ^= p >> 15;
    p -= p << 17;
    p += p << 7;
    p += p << 4;
    p ^= p >> 5;
    p += p << 16;
    p ^= p >> 7;
    p ^= p >> 3;
    p ^= p << 6;
    p ^= p >> 17;
    return p;
}

/// The subset of texel (x, y) of a block of 4 x 4, for two or three subsets. ASTC doubles the
/// coordinates of such small blocks; the third coordinate is 0.
constexpr uint8_t select_subset(uint32_t seed, uint32_t x, uint32_t y, uint32_t subsets) {
    seed += (subsets - 1) * 1024;
    const uint32_t hash = hash52(seed);
    const uint32_t by_subsets = subsets == 3 ? 6 : 5;
    const uint32_t by_seed = (seed & 2) != 0 ? 4 : 5;
    const uint32_t shift_x = (seed & 1) != 0 ? by_seed : by_subsets;
    const uint32_t shift_y = (seed & 1) != 0 ? by_subsets : by_seed;
    const auto slope = [&](uint32_t bit, uint32_t shift) {
        const uint32_t digit = hash >> bit & 15U;
        return digit * digit >> shift;
    };
    const auto plane = [&](uint32_t bit, uint32_t offset_bit) {
        return (slope(bit, shift_x) * 2 * x + slope(bit + 4, shift_y) * 2 * y +
                (hash >> offset_bit)) &
               63U;
    };
    const uint32_t first = plane(0, 14);
    const uint32_t second = plane(8, 10);
    const uint32_t third = subsets < 3 ? 0 : plane(16, 6);
    if (first >= second && first >= third) return 0;
    return second >= third ? 1 : 2;
}

constexpr UastcPattern make_pattern(uint32_t seed, uint32_t subsets) {
    UastcPattern pattern;
    for (uint32_t i = 16; i-- > 0;) {  // backwards, so that each subset's first texel remains
        const uint8_t subset = select_subset(seed, i % 4, i / 4, subsets);
        pattern.subset[i] = subset;
        pattern.anchor[subset] = static_cast<uint8_t>(i);
    }
    return pattern;
}

template <size_t N>
constexpr std::array<UastcPattern, N> make_patterns(const std::array<uint16_t, N>& seeds,
                                                    uint32_t subsets) {
    std::array<UastcPattern, N> patterns;
    for (size_t i = 0; i < N; ++i)
        patterns[i] = make_pattern(seeds[i], subsets);
    return patterns;
}

// ASTC's pattern numbers, in UASTC's order (UASTC LDR 4x4 specification, common patterns): those
// that BC7 has as well.
constexpr std::array<uint16_t, 30> seeds_two = {28,  20,  16,  29,  91,  9,   107, 72,  149, 204,
                                                50,  114, 496, 17,  78,  39,  252, 828, 43,  156,
                                                116, 210, 476, 273, 684, 359, 246, 195, 694, 524};
constexpr std::array<uint16_t, 19> seeds_two_of_mode_7 = {
    36, 48, 61, 137, 161, 183, 226, 281, 302, 307, 479, 495, 593, 594, 605, 799, 812, 988, 993};
constexpr std::array<uint16_t, 11> seeds_three = {260, 74, 32, 156, 183, 15, 745, 0, 335, 902, 254};

constexpr UastcPattern pattern_one[] = {UastcPattern{}};
constexpr auto patterns_two = make_patterns(seeds_two, 2);
constexpr auto patterns_two_of_mode_7 = make_patterns(seeds_two_of_mode_7, 2);
constexpr auto patterns_three = make_patterns(seeds_three, 3);

std::span<const UastcPattern> patterns_of(UastcPatternList list) {
    switch (list) {
        case UastcPatternList::one:
            return pattern_one;
        case UastcPatternList::two:
            return patterns_two;
        case UastcPatternList::two_of_mode_7:
            return patterns_two_of_mode_7;
        case UastcPatternList::three:
            return patterns_three;
    }
    return {};
}

}  // namespace

const UastcPattern* uastc_pattern(UastcPatternList list, uint32_t index) {
    const std::span<const UastcPattern> patterns = patterns_of(list);
    return index < patterns.size() ? &patterns[index] : nullptr;
}

}  // namespace obscura
