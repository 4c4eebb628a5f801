// tests/film/noise_test.cpp - the noise of an image from two states of it, against known answers.
// SPDX-License-Identifier: Apache-2.0
#include "film/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <gmock/gmock.h>
#include <random>

namespace obscura {
namespace {

/// An opaque grey image whose pixels all have the same numbers of samples.
struct GreyImage {
    GreyImage(int edge, float value, int count, int count_before)
        : side(edge),
          pixels(static_cast<size_t>(edge) * static_cast<size_t>(edge) * 4, value),
          before(pixels),
          groups{edge, edge},
          samples(groups.count(), count),
          samples_before(groups.count(), count_before) {}

    SampledImage view(double white = 1) {
        for (std::vector<float>* const image : {&pixels, &before}) {
            for (size_t i = 3; i < image->size(); i += 4)
                (*image)[i] = 1;
        }
        return {side, side, 4, pixels, before, samples, samples_before, white};
    }
    void set(std::vector<float>& image, size_t pixel, float value) {
        std::fill_n(image.begin() + static_cast<long>(4 * pixel), 3, value);
    }

    int side;
    std::vector<float> pixels, before;
    PixelGroups groups;
    std::vector<int> samples, samples_before;
};

TEST(Noise, ADifferenceBetweenPartsIsTheDeviationOfASample) {
    // Means of 48 and of the first 16 samples differ by a variance of (1/16 - 1/48) of a sample's.
    GreyImage image(12, 0.5f, 48, 16);
    image.before.assign(image.before.size(), 0.6f);
    const double variance = 0.1 * 0.1 / (1.0 / 16 - 1.0 / 48);
    const double expected = std::sqrt(variance / (0.5 * 0.5 + 0.1 * 0.1));
    const std::vector<float> deviations = sample_deviations(image.view());
    for (const float deviation : deviations)
        EXPECT_NEAR(deviation, expected, 1e-5);
    EXPECT_NEAR(
        image_noise(deviations, image.samples, image.groups), expected / std::sqrt(48.0), 1e-6);
}

TEST(Noise, IsRelativeToWhatIsDisplayedAsWhite) {
    GreyImage image(8, 1e-3f, 32, 16);
    image.before.assign(image.before.size(), 2e-3f);
    GreyImage bright(8, 1.0f, 32, 16);
    bright.before.assign(bright.before.size(), 2.0f);
    EXPECT_NEAR(sample_deviations(image.view(1e-3))[0], sample_deviations(bright.view())[0], 1e-4);
    EXPECT_LT(sample_deviations(image.view())[0], 0.1f) << "nearly black";
}

TEST(Noise, AlphaCountsAsItIsSeenOverWhite) {
    for (const double white : {1.0, 3.0}) {
        GreyImage image(8, 0.0f, 48, 16);
        const SampledImage seen = image.view(white);
        for (size_t i = 3; i < image.pixels.size(); i += 4) {
            image.pixels[i] = 0.5f;
            image.before[i] = 0.6f;
        }
        const double expected = 0.1 * std::sqrt(48.0 * 16 / 32) / std::sqrt(0.25 + 0.01);
        for (const float deviation : sample_deviations(seen))
            EXPECT_NEAR(deviation, expected, 1e-5);
    }
}

TEST(Noise, APixelWithoutNeighboursIsJudgedByItself) {
    GreyImage image(1, 0.5f, 48, 16);
    image.set(image.before, 0, 0.6f);
    EXPECT_GT(sample_deviations(image.view())[0], 0.1f);
}

TEST(Noise, GroupsAreTheColoursOfAChessboardInEachBlock) {
    const PixelGroups groups{17, 9};
    EXPECT_EQ(groups.count(), 2U * 3 * 2);
    EXPECT_EQ(groups.of(0, 0), groups.of(7, 7));
    EXPECT_EQ(groups.of(0, 0) + 1, groups.of(1, 0));
    EXPECT_EQ(groups.of(8, 0), 2U);
    EXPECT_EQ(groups.of(16, 8), 10U);
    EXPECT_THAT(groups.sizes(), testing::ElementsAre(32, 32, 32, 32, 4, 4, 4, 4, 4, 4, 1, 0));
}

TEST(Noise, APixelIsJudgedByThoseOfTheOtherColourInItsBlockAndNearIt) {
    GreyImage image(40, 0.0f, 32, 16);
    constexpr int x_0 = 17;  // in the third block of 8, one pixel from its left edge
    constexpr int y_0 = 20;
    image.set(image.pixels, 40 * y_0 + x_0, 5.0f);
    const std::vector<float> deviations = sample_deviations(image.view());
    for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 40; ++x) {
            const bool is_near = x / 8 == 2 && y / 8 == 2;
            const bool is_left = x / 8 == 1 && y / 8 == 2;  // 17 lies in the margin around
            const bool is_other = (x + y) % 2 != (x_0 + y_0) % 2;
            EXPECT_EQ(deviations[image.groups.of(x, y)] > 0, (is_near || is_left) && is_other)
                << x << ' ' << y;
        }
    }
}

TEST(Noise, AGroupCountsByItsPixels) {
    // Of 9 x 8 pixels 32 each are in the groups of the first block, 4 each in those of the second.
    const PixelGroups groups{9, 8};
    const std::vector<float> deviations = {1, 1, 2, 2};
    const std::vector<int> samples = {16, 16, 64, 16};
    const double mean = (64 * 1.0 / 16 + 4 * 4.0 / 64 + 4 * 4.0 / 16) / 72;
    EXPECT_NEAR(image_noise(deviations, samples, groups), std::sqrt(mean), 1e-9);
}

TEST(Noise, RandomSamplesShowTheirDeviation) {
    constexpr double deviation = 0.3;
    constexpr double mean = 0.8;
    GreyImage image(64, 0, 32, 16);
    std::mt19937 random(1);
    std::normal_distribution<double> normal(mean, deviation);
    for (size_t pixel = 0; pixel < image.pixels.size() / 4; ++pixel) {
        for (size_t c = 0; c < 3; ++c) {
            double sum = 0;
            for (int i = 0; i < 32; ++i) {
                sum += normal(random);
                if (i == 15) image.before[4 * pixel + c] = static_cast<float>(sum / 16);
            }
            image.pixels[4 * pixel + c] = static_cast<float>(sum / 32);
        }
    }
    const std::vector<float> deviations = sample_deviations(image.view());
    const double expected = deviation / std::sqrt(mean * mean + 0.1 * 0.1);
    EXPECT_NEAR(
        image_noise(deviations, image.samples, image.groups), expected / std::sqrt(32.0), 0.002);
    for (const float one : deviations)
        EXPECT_NEAR(one, expected, 0.4 * expected);
}

}  // namespace
}  // namespace obscura
