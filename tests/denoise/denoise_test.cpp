// tests/denoise/denoise_test.cpp - noise goes, the light stays, and so do edges and clean pixels.
// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"
#include "denoise/wall.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace obscura {
namespace {

TEST(Denoise, WhatHasNoNoiseStays) {
    Wall wall;
    wall.light([](int x, int y) { return x / 7 % 2 == y / 5 % 2 ? 1.0f : 30.0f; }, 0);
    const std::vector<float> out = wall.denoised();
    for (size_t i = 0; i < out.size(); ++i)
        ASSERT_NEAR(out[i], wall.halves[0][i], 1e-5f * wall.halves[0][i]) << i;
}

TEST(Denoise, NoiseFallsByAnOrderOfMagnitudeAndTheLightStays) {
    Wall wall;
    wall.light(even, 0.3f);
    const std::vector<float> out = wall.denoised();
    EXPECT_LT(mean_square(out, even), mean_square(wall.mean(), even) / 30);
    EXPECT_NEAR(total_light(out) / total_light(wall.mean()), 1, 1e-5);
}

/// Two walls with a corner between them: the features show the edge that the noise hides.
TEST(Denoise, EdgesOfFeaturesStaySharp) {
    const auto truth = [](int x, int /*y*/) { return x < width / 2 ? 1.0f : 1.3f; };
    Wall wall;
    wall.light(truth, 0.3f);
    for (size_t i = 0; i < pixels; ++i) {
        if (i % width >= width / 2) std::swap(wall.normal[3 * i], wall.normal[3 * i + 2]);
    }
    const std::vector<float> out = wall.denoised();
    for (const int x : {width / 2 - 1, width / 2}) {
        double column = 0;
        for (size_t y = 0; y < height; ++y)
            column += static_cast<double>(out[3 * (y * width + static_cast<size_t>(x))]) / height;
        EXPECT_NEAR(column, static_cast<double>(truth(x, 0)), 0.06) << x;
    }
}

/// A shadow's edge that no feature shows.
TEST(Denoise, EdgesOfLightStay) {
    const auto truth = [](int x, int /*y*/) { return x < width / 2 ? 0.2f : 2.0f; };
    Wall wall;
    wall.light(truth, 0.3f);
    const std::vector<float> out = wall.denoised();
    EXPECT_LT(mean_square(out, truth), mean_square(wall.mean(), truth) / 5);
}

TEST(Denoise, TextureComesBackAsItWas) {
    const auto paint = [](int x, int y) { return (x + y) % 2 == 0 ? 0.3f : 0.8f; };
    Wall wall;
    for (size_t i = 0; i < wall.albedo.size(); ++i) {
        const size_t pixel = i / 3;
        wall.albedo[i] = paint(static_cast<int>(pixel % width), static_cast<int>(pixel / width));
    }
    wall.light(paint, 0.3f);
    const std::vector<float> out = wall.denoised();
    EXPECT_LT(mean_square(out, paint), mean_square(wall.mean(), paint) / 20);
}

TEST(Denoise, AnOutliersLightGoesToItsNeighbourhood) {
    constexpr size_t middle = 40 * width + 48;
    constexpr size_t corner = 0;  // where the image repeats itself beyond its edges
    for (const size_t pixel : {middle, corner}) {
        Wall wall;
        wall.light(even, 0.1f);
        for (size_t c = 0; c < 3; ++c)
            wall.halves[0][3 * pixel + c] = 1000;
        std::vector<float> out = wall.mean();
        const DenoiseReport report = denoise(wall.input(), std::vector<LightImage>{{out, 3}});
        EXPECT_GT(report.outlier_share, 0) << pixel;
        EXPECT_LT(out[3 * pixel], 3.0f) << pixel;
        EXPECT_NEAR(total_light(out) / total_light(wall.mean()), 1, 1e-5) << pixel;
    }
}

TEST(Denoise, AHighlightInBothHalvesStays) {
    Wall wall;
    wall.light([](int x, int y) { return x == 48 && y == 40 ? 100.0f : 2.0f; }, 0.1f);
    EXPECT_GT(wall.denoised()[3 * (40 * width + 48)], 70);
}

/// By chance alone the nearest pixels tell that filters do harm, in one place or another.
TEST(Denoise, NoPatchesOfNoiseStay) {
    Wall wall;
    wall.light(even, 1);
    const std::vector<float> out = wall.denoised();
    std::vector<float> errors;
    for (size_t i = 0; i < pixels; ++i)
        errors.push_back(std::abs(out[3 * i] - 2));
    std::sort(errors.begin(), errors.end());
    EXPECT_LT(errors[pixels / 2], 0.1f);
    EXPECT_LT(errors[pixels * 999 / 1000], 1.8f) << "of noise of 1.4";
}

/// What a filter does to dark pixels counts by their own brightness, not by what it spreads there.
TEST(Denoise, DarkPixelsAmongGlintsStayDark) {
    const auto glints = [](int x, int y) { return (x + 3 * y) % 11 == 0 ? 20.0f : 0.02f; };
    Wall wall;
    wall.light(glints, 0.5f);
    const auto error_of_dark = [&](const std::vector<float>& image) {
        double sum = 0;
        for (size_t i = 0; i < pixels; ++i) {
            const float value = glints(static_cast<int>(i % width), static_cast<int>(i / width));
            if (value < 1) sum += std::pow(static_cast<double>(image[3 * i] - value), 2);
        }
        return sum;
    };
    EXPECT_LT(error_of_dark(wall.denoised()), 2.2 * error_of_dark(wall.mean()));
}

/// Layers that add up to the beauty still do, whatever the noise and the outliers in them.
TEST(Denoise, LayersStillAddUp) {
    Wall wall;
    wall.light(even, 0.5f);
    wall.halves[1][3 * 777] = 500;
    std::vector<float> beauty = wall.mean();
    std::vector<float> one(beauty.size());
    std::vector<float> other(4 * pixels, 0.25f);  // a fourth channel is nobody's business
    for (size_t i = 0; i < beauty.size(); ++i) {
        one[i] = beauty[i] * static_cast<float>(i % 97) / 97.0f;
        other[i / 3 * 4 + i % 3] = beauty[i] - one[i];
    }
    denoise(wall.input(), std::vector<LightImage>{{beauty, 3}, {one, 3}, {other, 4}});
    for (size_t i = 0; i < beauty.size(); ++i)
        ASSERT_NEAR(one[i] + other[i / 3 * 4 + i % 3], beauty[i], 2e-5f * beauty[i]) << i;
    for (size_t i = 3; i < other.size(); i += 4)
        ASSERT_EQ(other[i], 0.25f);
}

/// Layers are light: whatever the filter takes from others, none gets less than nothing.
TEST(Denoise, LayersAreNeverNegative) {
    Wall wall;
    wall.light(even, 0.9f);
    wall.halves[1][3 * 777] = 500;
    std::vector<float> beauty = wall.mean();
    std::vector<float> spots(beauty.size());
    std::vector<float> other(beauty);
    for (size_t i = 0; i < beauty.size(); i += 3) {
        const size_t x = i / 3 % width;
        if (x >= 63 || i == size_t{3} * 777) continue;
        for (size_t c = i; c < i + 3; ++c) {
            spots[c] = x % 9 == 8 ? beauty[c] : 0.0f;
            other[c] = beauty[c] - spots[c];
        }
    }
    const double light = total_light(spots);
    denoise(wall.input(), std::vector<LightImage>{{beauty, 3}, {spots, 3}, {other, 3}});
    EXPECT_GE(*std::min_element(spots.begin(), spots.end()), 0);
    EXPECT_GE(*std::min_element(other.begin(), other.end()), 0);
    EXPECT_NEAR(total_light(spots), light, 0.05 * light);
    for (size_t i = 0; i < beauty.size(); ++i) {
        ASSERT_NEAR(spots[i] + other[i], beauty[i], 2e-5f * beauty[i]) << i;
    }
}

TEST(Denoise, PixelsWithoutAlphaAreLeftAloneAndTellNothing) {
    Wall wall;
    wall.light(even, 0.3f);
    for (size_t i = 0; i < pixels; ++i) {
        if (i % width >= 20) continue;
        wall.alpha[i] = wall.opacity[i] = 0;
        for (size_t c = 0; c < 3; ++c)
            wall.albedo[3 * i + c] = wall.normal[3 * i + c] = wall.halves[0][3 * i + c] =
                wall.halves[1][3 * i + c] = 0;
    }
    const std::vector<float> out = wall.denoised();
    double error = 0;
    for (size_t i = 0; i < pixels; ++i) {
        if (i % width < 20) {
            ASSERT_EQ(out[3 * i], 0) << i;
        } else {
            error += std::pow(static_cast<double>(out[3 * i]) - 2, 2) / pixels;
        }
    }
    EXPECT_LT(error, 0.08 * 0.08) << "of a variance of 0.42 * 0.42";
}

/// They are above what 32 bits hold the square of.
TEST(Denoise, ValuesBeyondAllSquaresStayAndHarmNobody) {
    Wall wall;
    wall.light([](int x, int y) { return x / 8 == 5 && y / 8 == 4 ? 1e30f : 2.0f; }, 0.3f);
    const std::vector<float> noisy = wall.mean();
    const std::vector<float> out = wall.denoised();
    double error = 0;
    for (size_t i = 0; i < pixels; ++i) {
        if (noisy[3 * i] > 1e10f) {
            ASSERT_EQ(out[3 * i], noisy[3 * i]) << i;
        } else {
            error += std::pow(static_cast<double>(out[3 * i]) - 2, 2) / pixels;
        }
    }
    EXPECT_LT(error, 0.08 * 0.08);
}

/// Premultiplied: a pixel that is half covered keeps half of the light.
TEST(Denoise, HalfCoveredPixelsKeepTheirShare) {
    const auto truth = [](int x, int /*y*/) { return x == 48 ? 1.0f : 2.0f; };
    Wall wall;
    wall.light(truth, 0.2f);
    for (size_t y = 0; y < height; ++y)
        wall.alpha[y * width + 48] = 0.5f;
    const std::vector<float> out = wall.denoised();
    double column = 0;
    for (size_t y = 0; y < height; ++y)
        column += static_cast<double>(out[3 * (y * width + 48)]) / height;
    EXPECT_NEAR(column, 1, 0.02);
}

TEST(Denoise, AnyNumberOfThreadsGivesTheSameBits) {
    Wall wall;
    wall.light([](int x, int y) { return 1 + 0.01f * static_cast<float>(x * y % 50); }, 0.6f);
    std::vector<float> alone;
    {
        const ThreadArena one(1);
        alone = wall.denoised();
    }
    const ThreadLimit many(5);
    EXPECT_EQ(wall.denoised(), alone);
}

TEST(Denoise, TinyImagesAreImages) {
    const std::vector<float> three(3, 1.0f);
    const std::vector<float> one(1, 1.0f);
    std::vector<float> out = three;
    DenoiseInput input;
    input.width = input.height = 1;
    input.color = input.albedo = input.normal = {three, three};
    input.depth = input.opacity = one;
    denoise(input, std::vector<LightImage>{{out, 3}});
    EXPECT_EQ(out, three);
}

}  // namespace
}  // namespace obscura
