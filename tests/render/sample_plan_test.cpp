// tests/render/sample_plan_test.cpp - which pixels adaptive sampling goes on with.
// SPDX-License-Identifier: Apache-2.0
#include "render/sample_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <gmock/gmock.h>

namespace obscura {
namespace {

using testing::Each;
using testing::ElementsAre;

TEST(SamplePlan, LevelsDoubleFromHalfTheLeastToTheMost) {
    EXPECT_THAT(sample_levels(16, 128), ElementsAre(8, 16, 32, 64, 128));
    EXPECT_THAT(sample_levels(16, 100), ElementsAre(8, 16, 32, 64, 100));
    EXPECT_THAT(sample_levels(16, 16), ElementsAre(8, 16));
    EXPECT_THAT(sample_levels(5, 11), ElementsAre(2, 5, 10, 11));
    EXPECT_THAT(sample_levels(2, 2), ElementsAre(1, 2));
    EXPECT_EQ(sample_levels(1 << 19, 1 << 20).back(), 1 << 20);
}

TEST(SamplePlan, SamplesAreInProportionToTheDeviation) {
    // The mean deviation is 2: for a noise of 0.1 a pixel of deviation s wants 2 s / 0.1^2 samples,
    // which are 200 and 600. Then the noise is ((1/200 + 9/600) / 2)^(1/2) = 0.1.
    const std::vector<float> deviations = {1, 3, 1, 3, 1, 3};
    const std::vector<int> samples = {141, 424, 142, 425, 16, 16};
    EXPECT_THAT(pixels_in_need(deviations, samples, {0.1, 4096}), ElementsAre(1, 1, 0, 0, 1, 1));
}

TEST(SamplePlan, HopelessPixelsDoNotMakeOthersTakeMore) {
    std::vector<float> deviations(1000, 1.0f);
    const std::vector<int> samples(1000, 73);
    const NoiseGoal goal{0.1, 1000};
    EXPECT_THAT(pixels_in_need(deviations, samples, goal), Each(0)) << "100 are wanted";
    deviations[500] = 1e6f;
    const std::vector<uint8_t> wanted = pixels_in_need(deviations, samples, goal);
    EXPECT_EQ(wanted[500], 1);
    EXPECT_EQ(std::count(wanted.begin(), wanted.end(), 1), 1);
}

TEST(SamplePlan, NobodyGoesBeyondTheMostAndCleanPixelsStop) {
    EXPECT_THAT(pixels_in_need(std::vector<float>{9, 9}, std::vector<int>{64, 64}, {1e-4, 64}),
                Each(0));
    EXPECT_THAT(pixels_in_need(std::vector<float>{0, 0}, std::vector<int>{16, 16}, {1e-4, 64}),
                Each(0));
    EXPECT_THAT(pixels_in_need(std::vector<float>{0, 1e-30f}, std::vector<int>{2, 2}, {0.01, 64}),
                Each(0));
}

}  // namespace
}  // namespace obscura
