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

/// Groups of ten pixels that cost the same.
class Groups {
public:
    Groups(std::vector<float> deviations, std::vector<int> samples)
        : costs(deviations.size(), 3.0f),
          sizes(deviations.size(), 10),
          deviations_(std::move(deviations)),
          samples_(std::move(samples)) {}

    std::vector<int> next(double noise, int least, int most) const {
        return next_samples(
            {deviations_, samples_, costs, sizes}, noise, sample_levels(least, most));
    }

    std::vector<float> costs;
    std::vector<int> sizes;

private:
    std::vector<float> deviations_;
    std::vector<int> samples_;
};

TEST(SamplePlan, LevelsDoubleFromHalfTheLeastAndLieHalfwayBetween) {
    EXPECT_THAT(sample_levels(16, 128), ElementsAre(8, 16, 32, 48, 64, 96, 128));
    EXPECT_THAT(sample_levels(16, 40), ElementsAre(8, 16, 32, 40));
    EXPECT_THAT(sample_levels(16, 16), ElementsAre(8, 16));
    EXPECT_THAT(sample_levels(5, 11), ElementsAre(2, 5, 10, 11));
    EXPECT_THAT(sample_levels(32, 64), ElementsAre(16, 32, 48, 64));
    EXPECT_THAT(sample_levels(2, 2), ElementsAre(1, 2));
    EXPECT_EQ(sample_levels(1 << 19, 1 << 20).back(), 1 << 20);
}

TEST(SamplePlan, SamplesAreInProportionToTheDeviation) {
    // The mean deviation is 2: for a noise of 0.1 a pixel of deviation s wants 2 s / 0.1^2 samples,
    // which are 200 and 600. Then the noise is ((1/200 + 9/600) / 2)^(1/2) = 0.1. The nearest
    // levels are 192 and 512.
    const Groups groups({1, 3, 1, 3, 1, 3, 1, 3}, {128, 384, 192, 512, 16, 16, 96, 256});
    EXPECT_THAT(groups.next(0.1, 16, 4096), ElementsAre(192, 512, 192, 512, 32, 32, 192, 512));
}

TEST(SamplePlan, DearPixelsTakeFewer) {
    // With costs 1 and 16 and equal deviations the shares are 4 : 1. For a noise of 0.1 the mean of
    // 1 / n is 0.01: n is 250 and 62.5.
    Groups groups({1, 1}, {64, 64});
    groups.costs = {1, 16};
    EXPECT_THAT(groups.next(0.1, 16, 4096), ElementsAre(128, 64));
    const Groups later({1, 1}, {128, 64});
    EXPECT_THAT(later.next(0.1, 16, 4096), ElementsAre(128, 96)) << "where they cost the same";
}

TEST(SamplePlan, HopelessPixelsDoNotMakeOthersTakeMore) {
    const std::vector<int> samples(1000, 96);
    EXPECT_THAT(Groups(std::vector<float>(1000, 1.0f), samples).next(0.1, 16, 1000), Each(96))
        << "100 are wanted";
    std::vector<float> deviations(1000, 1.0f);
    deviations[500] = 1e6f;
    const std::vector<int> next = Groups(deviations, samples).next(0.1, 16, 1000);
    EXPECT_EQ(next[500], 192);
    EXPECT_EQ(std::count(next.begin(), next.end(), 96), 999);
}

TEST(SamplePlan, NobodyGoesBeyondTheMostAndCleanPixelsStop) {
    EXPECT_THAT(Groups({9, 9}, {64, 64}).next(1e-4, 16, 64), Each(64));
    EXPECT_THAT(Groups({0, 0}, {16, 16}).next(1e-4, 16, 64), Each(16));
    EXPECT_THAT(Groups({0, 1e-30f}, {2, 2}).next(0.01, 2, 64), Each(2));
    Groups empty({5, 5}, {0, 64});
    empty.sizes = {0, 10};
    EXPECT_EQ(empty.next(0.1, 16, 4096)[0], 0) << "no pixels";
}

}  // namespace
}  // namespace obscura
