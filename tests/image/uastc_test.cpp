// tests/image/uastc_test.cpp - every mode of UASTC against other decoders and ASTC's formulas.
// SPDX-License-Identifier: Apache-2.0
#include "image/uastc.h"

#include "image/texel_hash.h"
#include "image/uastc_encoder.h"
#include "image/uastc_patterns.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace obscura {
namespace {

using namespace testing_images;

using Block = std::span<const std::byte, uastc_block_bytes>;

/// SplitMix64 (Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators", 2014).
class SplitMix {
public:
    explicit SplitMix(uint64_t seed) : state_(seed) {}

    uint64_t next() {
        state_ += 0x9E3779B97F4A7C15ULL;
        uint64_t z = state_;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
        return z ^ (z >> 31);
    }

private:
    uint64_t state_;
};

/// A block of random bits, with the mode's code and a pattern that exists.
std::array<std::byte, uastc_block_bytes> random_block(size_t mode, SplitMix& random) {
    const UastcModeEntry& entry = uastc_mode_entries[mode];
    uint64_t low = random.next();
    const uint64_t high = random.next();
    const int code_bits = static_cast<int>(entry.code.size());
    low = low >> code_bits << code_bits | std::stoull(std::string(entry.code), nullptr, 2);
    if (entry.patterns > 1) {
        const int at = code_bits + entry.hint_bits;
        const uint64_t mask = (mode == 3 ? 15ULL : 31ULL) << at;
        const uint64_t pattern = (low & mask) >> at;
        low = (low & ~mask) | pattern % entry.patterns << at;
    }
    std::array<std::byte, uastc_block_bytes> bytes = {};
    for (size_t i = 0; i < 8; ++i) {
        bytes[i] = static_cast<std::byte>(low >> 8 * i & 0xFF);
        bytes[8 + i] = static_cast<std::byte>(high >> 8 * i & 0xFF);
    }
    return bytes;
}

/// Hashes of 1024 blocks of each mode. Linear: Binomial's transcoder (as in three.js r160) to
/// RGBA32. sRGB, with alpha as 0: its ASTC blocks, decoded by Arm's astcenc 4.2 with -ds, whose
/// alpha goes through half floats.
struct Answer {
    uint64_t linear;
    uint64_t srgb;
};
constexpr Answer answers[] = {
    {0x3B08C4FFC02E51E7ULL, 0xD1839AF02E732AD5ULL}, {0xF9B648065CDAFFC7ULL, 0xE7D03C9F4953A401ULL},
    {0x48E8D40155279985ULL, 0xDC264062B97AC70DULL}, {0xD094809BED52B48AULL, 0x2DB9B12820508434ULL},
    {0xCCD9E82901FD6CD9ULL, 0x7239C8A76DADEC51ULL}, {0x2436FDE72083BFA9ULL, 0x87F965FF9B825A5DULL},
    {0xD9D72AF14C0CD741ULL, 0x26F25CD6C6B5B991ULL}, {0x12F0DA9EC5CDD1B4ULL, 0xA2654AA74694AF55ULL},
    {0x2FF9F071CDBE5625ULL, 0x4B1799015FCF9A05ULL}, {0xF4D89B8086439137ULL, 0x26EA24FE2BDD77D3ULL},
    {0x0441D997CEADCCEAULL, 0x2A32B40C3A9BE035ULL}, {0x40EDA42FEE7D564FULL, 0x2EAB4963E360C9CCULL},
    {0x687EAF2574D3B072ULL, 0x98213E97CB0568BFULL}, {0x8CC099E43737C193ULL, 0x8C3C03E1C14DB34FULL},
    {0x9A16575E22EA9C74ULL, 0xB8D25A3CE14138C5ULL}, {0x2C83CC577A778C42ULL, 0xA5BB5410051241A9ULL},
    {0x99FE43F0B69C91D9ULL, 0x797730B04246AFE9ULL}, {0xBF6ACC4BCA018992ULL, 0x21F10E883182F65BULL},
    {0xD6E1FF9A44612400ULL, 0xF82ABEC7A1C6C547ULL},
};

TEST(Uastc, ThousandBlocksOfEachModeAsOtherDecodersSeeThem) {
    for (size_t mode = 0; mode < std::size(answers); ++mode) {
        SplitMix random(mode);
        uint64_t linear = texel_hash({}), srgb = linear;
        for (int i = 0; i < 1024; ++i) {
            const auto bytes = random_block(mode, random);
            TexelBlock texels = {};
            ASSERT_TRUE(decode_uastc_block(bytes, false, texels)) << mode;
            linear = texel_hash(texels, linear);
            ASSERT_TRUE(decode_uastc_block(bytes, true, texels)) << mode;
            for (uint32_t& texel : texels)
                texel &= 0xFFFFFFU;
            srgb = texel_hash(texels, srgb);
        }
        EXPECT_EQ(linear, answers[mode].linear) << "mode " << mode;
        EXPECT_EQ(srgb, answers[mode].srgb) << "mode " << mode;
    }
}

uint32_t below(uint32_t end, SplitMix& random) {
    return static_cast<uint32_t>(random.next() % end);
}

UastcNumbers random_numbers(size_t mode, SplitMix& random) {
    const UastcModeEntry& entry = uastc_mode_entries[mode];
    UastcNumbers numbers;
    numbers.mode = mode;
    numbers.pattern = random.next() % entry.patterns;
    if (entry.planes == 2 && entry.colors > 2) numbers.apart = random.next() % 4;
    const size_t values = 2 * entry.colors * entry.subsets;
    for (size_t i = 0; i < values; ++i) {
        if (entry.base > 1)
            numbers.digits.push_back(below(static_cast<uint32_t>(entry.base), random));
        numbers.low_bits.push_back(below(1U << entry.bits, random));
    }
    for (size_t i = 0; i < 16; ++i) {
        const int bits = entry.weight_bits - (uastc_is_anchor(numbers, i) ? 1 : 0);
        for (uint32_t& weight : numbers.weights[i])
            weight = below(1U << bits, random);
    }
    return numbers;
}

TEST(Uastc, EveryModeFollowsAstcsFormulas) {
    SplitMix random(1);
    for (size_t mode = 0; mode < uastc_mode_entries.size(); ++mode) {
        if (mode == uastc_solid_mode) continue;
        for (int repeat = 0; repeat < 100; ++repeat) {
            const UastcNumbers numbers = random_numbers(mode, random);
            const std::vector<std::byte> bytes = uastc_block(numbers);
            const bool srgb = repeat % 2 != 0;
            TexelBlock texels = {};
            ASSERT_TRUE(decode_uastc_block(Block(bytes), srgb, texels)) << mode;
            for (size_t i = 0; i < 64; ++i) {
                const uint32_t got = texels[i / 4] >> 8 * (i % 4) & 0xFFU;
                ASSERT_EQ(got, uastc_expected(numbers, i / 4, i % 4, srgb))
                    << "mode " << mode << " pattern " << numbers.pattern << " texel " << i / 4
                    << " channel " << i % 4;
            }
        }
    }
}

TEST(Uastc, ASolidBlockIsItsFourBytes) {
    BitWriter out;
    out.put(0b10111, 5);
    out.put(0x80604020U, 32);
    std::vector<std::byte> bytes = out.bytes();
    bytes.resize(uastc_block_bytes);
    TexelBlock texels = {};
    ASSERT_TRUE(decode_uastc_block(Block(bytes), true, texels));
    for (const uint32_t texel : texels)
        EXPECT_EQ(texel, 0x80604020U);
}

TEST(Uastc, PatternsAreThePrintedOnes) {
    const auto check = [](UastcPatternList list, size_t mode, uint32_t count) {
        for (uint32_t p = 0; p < count; ++p) {
            const UastcPattern* pattern = uastc_pattern(list, p);
            ASSERT_NE(pattern, nullptr);
            for (size_t i = 0; i < 16; ++i) {
                EXPECT_EQ(pattern->subset[i], uastc_subset(mode, p, i)) << mode << " " << p;
                EXPECT_LE(pattern->anchor[pattern->subset[i]], i);
            }
        }
        EXPECT_EQ(uastc_pattern(list, count), nullptr);
    };
    check(UastcPatternList::one, 0, 1);
    check(UastcPatternList::two, 2, 30);
    check(UastcPatternList::three, 3, 11);
    check(UastcPatternList::two_of_mode_7, 7, 19);
}

TEST(Uastc, WhatDoesNotExistIsRefused) {
    TexelBlock texels = {};
    std::array<std::byte, uastc_block_bytes> bytes = {};
    bytes[0] = std::byte{0b1000101};  // reserved
    EXPECT_FALSE(decode_uastc_block(bytes, false, texels));
    for (const size_t mode : {2U, 3U, 4U, 7U, 9U, 16U}) {
        const UastcModeEntry& entry = uastc_mode_entries[mode];
        BitWriter out;
        out.put_code(std::string(entry.code.rbegin(), entry.code.rend()));
        out.put(0, entry.hint_bits);
        out.put(entry.patterns, mode == 3 ? 4 : 5);
        std::vector<std::byte> block = out.bytes();
        block.resize(uastc_block_bytes);
        EXPECT_FALSE(decode_uastc_block(Block(block), false, texels)) << mode;
    }
}

}  // namespace
}  // namespace obscura
