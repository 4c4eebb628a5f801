// tests/film/noise_test.cpp - the noise of an image from two states of it, against known answers.
// SPDX-License-Identifier: Apache-2.0
#include "film/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace obscura {
namespace {

/// A grey image of which every pixel has the same numbers of samples.
struct GreyImage {
    GreyImage(int edge, float value, int count, int count_before)
        : side(edge),
          pixels(static_cast<size_t>(edge) * static_cast<size_t>(edge) * 4, value),
          before(pixels),
          samples(pixels.size() / 4, count),
          samples_before(pixels.size() / 4, count_before) {}

    SampledImage view(double white = 1) const {
        return {side, side, 4, pixels, before, samples, samples_before, white};
    }
    void set(std::vector<float>& image, size_t pixel, float value) {
        std::fill_n(image.begin() + static_cast<long>(4 * pixel), 3, value);
    }

    int side;
    std::vector<float> pixels, before;
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
    EXPECT_NEAR(image_noise(deviations, image.samples), expected / std::sqrt(48.0), 1e-6);
}

TEST(Noise, IsRelativeToWhatIsDisplayedAsWhite) {
    GreyImage image(8, 1e-3f, 32, 16);
    image.before.assign(image.before.size(), 2e-3f);
    GreyImage bright(8, 1.0f, 32, 16);
    bright.before.assign(bright.before.size(), 2.0f);
    EXPECT_NEAR(sample_deviations(image.view(1e-3))[0], sample_deviations(bright.view())[0], 1e-4);
    EXPECT_LT(sample_deviations(image.view())[0], 0.1f) << "nearly black";
}

TEST(Noise, APixelWithoutNeighboursIsJudgedByItself) {
    GreyImage image(1, 0.5f, 48, 16);
    image.set(image.before, 0, 0.6f);
    EXPECT_GT(sample_deviations(image.view())[0], 0.1f);
}

TEST(Noise, APixelIsJudgedByItsNeighboursAlone) {
    GreyImage image(21, 0.0f, 32, 16);
    const size_t center = 10 * 21 + 10;
    image.set(image.pixels, center, 5.0f);
    const std::vector<float> deviations = sample_deviations(image.view());
    EXPECT_EQ(deviations[center], 0.0f);
    constexpr int reach = noise_window / 2;
    for (int y = 0; y < 21; ++y) {
        for (int x = 0; x < 21; ++x) {
            const bool near = std::abs(x - 10) <= reach && std::abs(y - 10) <= reach;
            const size_t at = static_cast<size_t>(21 * y + x);
            EXPECT_EQ(deviations[at] > 0, near && at != center) << x << ' ' << y;
        }
    }
}

TEST(Noise, RandomSamplesShowTheirDeviation) {
    constexpr double deviation = 0.3;
    constexpr double mean = 0.8;
    GreyImage image(64, 0, 32, 16);
    std::mt19937 random(1);
    std::normal_distribution<double> normal(mean, deviation);
    for (size_t pixel = 0; pixel < image.samples.size(); ++pixel) {
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
    EXPECT_NEAR(image_noise(deviations, image.samples), expected / std::sqrt(32.0), 0.002);
    for (const float one : deviations)
        EXPECT_NEAR(one, expected, 0.4 * expected);
}

}  // namespace
}  // namespace obscura
