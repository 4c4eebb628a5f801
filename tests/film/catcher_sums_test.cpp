// tests/film/catcher_sums_test.cpp - the alpha of a shadow, and what lies behind it.
// SPDX-License-Identifier: Apache-2.0
#include "film/catcher_sums.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

/// Sample `slot` of a batch, with light and a background that cancels nothing.
CatcherSample sample(uint32_t slot, float shadowed, float unshadowed) {
    return {.slot = slot, .shadowed = shadowed, .unshadowed = unshadowed};
}

TEST(CatcherSums, AlphaIsARatioOfSumsNotAMeanOfRatios) {
    CatcherSum sum;
    add_catcher_samples({sample(0, 0, 3), sample(1, 1, 1)}, {0, 2}, std::span(&sum, 1));
    EXPECT_DOUBLE_EQ(shadow_alpha(sum.total()), 0.75);  // the mean of 1 and 0 is 0.5
    EXPECT_EQ(sum.total().transmitted, 2);
}

TEST(CatcherSums, AlphaStaysWithinItsRange) {
    EXPECT_EQ(shadow_alpha({}), 0);  // no light: nothing can be darker
    EXPECT_EQ(shadow_alpha({.shadowed = 2, .unshadowed = 1}), 0);
    EXPECT_EQ(shadow_alpha({.shadowed = 0, .unshadowed = 1}), 1);
    EXPECT_EQ(shadow_alpha({.shadowed = 0.1 + 0.2, .unshadowed = 0.1 + 0.2}), 0);
}

TEST(CatcherSums, SamplesGoToTheirPixels) {
    std::vector<CatcherSum> sums(3);
    add_catcher_samples({sample(1, 1, 2), sample(8, 3, 4), sample(11, 5, 6)}, {0, 4}, sums);
    EXPECT_EQ(sums[0].total().shadowed, 1);
    EXPECT_EQ(sums[1].total().transmitted, 0);
    EXPECT_EQ(sums[2].total().shadowed, 8);
    EXPECT_EQ(sums[2].total().unshadowed, 10);
}

TEST(CatcherSums, BatchesAddUpToTheSame) {
    std::vector<CatcherSample> all;
    for (uint32_t i = 0; i < 40; ++i)
        all.push_back(
            sample(i, 1e-3f * static_cast<float>(i * i), 1.0f / static_cast<float>(i + 1)));
    CatcherSum once;
    add_catcher_samples(all, {0, 40}, std::span(&once, 1));
    CatcherSum bit_by_bit;
    CatcherSum by_blocks;
    CatcherSum block;
    for (const CatcherSample& one : all) {
        const SampleRange own{one.slot, 1};
        const std::vector<CatcherSample> alone = {sample(0, one.shadowed, one.unshadowed)};
        add_catcher_samples(alone, own, std::span(&bit_by_bit, 1));
        add_catcher_samples(alone, own, std::span(&block, 1));
        if ((one.slot + 1) % sum_block_samples == 0 || one.slot == 39) {
            by_blocks.append(block);
            block = {};
        }
    }
    for (const CatcherSum& other : {bit_by_bit, by_blocks}) {
        EXPECT_EQ(once.total().shadowed, other.total().shadowed);
        EXPECT_EQ(once.total().unshadowed, other.total().unshadowed);
    }
}

/// A half dark catcher in three of four samples, before an opaque red.
TEST(CatcherSums, TheShadowLiesOverWhatIsBehind) {
    const CatcherLight sum{
        .shadowed = 1, .unshadowed = 2, .background = {3, 0, 0, 3}, .transmitted = 3};
    const std::array<float, 4> part = catcher_part(sum, 4);
    EXPECT_FLOAT_EQ(part[0], 0.375f);
    EXPECT_FLOAT_EQ(part[1], 0);
    EXPECT_FLOAT_EQ(part[3], 0.75f);
    const std::array<float, 4> alone =
        catcher_part({.shadowed = 1, .unshadowed = 2, .transmitted = 3}, 4);
    EXPECT_FLOAT_EQ(alone[0], 0);
    EXPECT_FLOAT_EQ(alone[3], 0.375f);
}

}  // namespace
}  // namespace obscura
