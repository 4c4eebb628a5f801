// tests/image/etc1s_test.cpp - ETC1S blocks against the tables of the ETC1 specification.
// SPDX-License-Identifier: Apache-2.0
#include "image/etc1s.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace obscura {
namespace {

TEST(Etc1s, ThePrintedExampleOfEtc1) {
    // The base color (28, 1, 2) is (231, 8, 16) in bytes; table 2 adds 29 at most.
    const TexelBlock texels = decode_etc1s_block({28, 1, 2, 2}, 0xFFFFFFFFU);
    for (const uint32_t texel : texels)
        EXPECT_EQ(texel, 255U | 37U << 8 | 45U << 16 | 255U << 24);
}

TEST(Etc1s, EveryTableAndSelectorIsClampedBasePlusStep) {
    constexpr int steps[8][2] = {
        {2, 8}, {5, 17}, {9, 29}, {13, 42}, {18, 60}, {24, 80}, {33, 106}, {47, 183}};
    for (int table = 0; table < 8; ++table) {
        for (int base = 0; base < 32; ++base) {
            const auto five_bits = static_cast<uint8_t>(base);
            const TexelBlock texels = decode_etc1s_block(
                {five_bits, 0, 31, static_cast<uint8_t>(table)}, 0xE4E4E4E4U);  // 0 1 2 3 0 1 ...
            const int eight_bits = base * 8 + base / 4;
            const int small = steps[table][0], large = steps[table][1];
            const int expected[] = {-large, -small, small, large};
            for (size_t i = 0; i < texels.size(); ++i) {
                const int step = expected[i % 4];
                EXPECT_EQ(texels[i] & 255U, std::clamp(eight_bits + step, 0, 255)) << base;
                EXPECT_EQ(texels[i] >> 8 & 255U, std::max(step, 0));
                EXPECT_EQ(texels[i] >> 16 & 255U, 255 + std::min(step, 0));
                EXPECT_EQ(texels[i] >> 24, 255U);
            }
        }
    }
}

TEST(TexelBlock, OnlyWhatLiesInsideIsWritten) {
    std::vector<uint32_t> texels(6 * 5, 0x11111111U);
    const TexelLevel level{texels.data(), 6, 5};
    EXPECT_EQ(level.block_count(), 4U);
    TexelBlock block;
    for (uint32_t i = 0; i < 16; ++i)
        block[i] = 0xAB000000U | i;
    write_block(level, 1, 1, block, 0xFF0000FFU);
    for (size_t y = 0; y < 5; ++y) {
        for (size_t x = 0; x < 6; ++x) {
            const uint32_t inside = 0xAB111100U | static_cast<uint32_t>(x - 4);
            EXPECT_EQ(texels[6 * y + x], y == 4 && x >= 4 ? inside : 0x11111111U) << x << " " << y;
        }
    }
}

}  // namespace
}  // namespace obscura
