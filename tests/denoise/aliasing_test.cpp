// tests/denoise/aliasing_test.cpp - noise of edges and textures is told from that of light.
// SPDX-License-Identifier: Apache-2.0
#include "denoise/aliasing.h"

#include "denoise/wall.h"
#include "denoise/weights.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace obscura {
namespace {

/// Halves whose difference is random in every pixel and channel.
struct NoisyPair {
    Rgb halves[2];

    explicit NoisyPair(unsigned seed, float size = 0.1f) {
        std::mt19937 random(seed);
        std::normal_distribution<float> spread(0, size);
        for (Rgb& half : halves) {
            for (Plane& plane : half) {
                plane = Plane(width, height, plane_border);
                for (int y = 0; y < height; ++y)
                    std::generate_n(plane.row(y), width, [&] { return 0.5f + spread(random); });
                plane.extend();
            }
        }
    }
};

double mean_of(const Plane& plane) {
    double sum = 0;
    for (int y = 0; y < height; ++y)
        sum += std::accumulate(plane.row(y), plane.row(y) + width, 0.0);
    return sum / pixels;
}

TEST(Aliasing, TheAlbedosOwnNoiseIsExplained) {
    const NoisyPair albedo(1);
    const NoisyPair normal(2);
    NoisyPair color = albedo;
    for (Rgb& half : color.halves) {
        for (size_t c = 0; c < 3; ++c) {  // each channel is lit otherwise
            const float light = 0.2f + 3.0f * static_cast<float>(c);
            half[c] = make_plane(width, height, plane_border, [&](int x, int y) {
                return light * half[c].row(y)[x];
            });
        }
    }
    const Plane share = aliasing_share(color.halves, albedo.halves, normal.halves);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            ASSERT_NEAR(share.row(y)[x], 1, 1e-4) << x << ' ' << y;
    }
}

TEST(Aliasing, LightsNoiseIsExplainedByChanceAlone) {
    const NoisyPair color(1), albedo(2), normal(3);
    // Of 9 pairs of numbers, the best of four regressions on one variable.
    EXPECT_NEAR(mean_of(aliasing_share(color.halves, albedo.halves, normal.halves)), 0.26, 0.02);
    const NoisyPair curved(3, 0.001f);
    EXPECT_NEAR(mean_of(aliasing_share(color.halves, albedo.halves, curved.halves)), 0.11, 0.02)
        << "normals that hardly differ explain nothing";
}

/// As instruction sets may differ, and interpolation.
TEST(Aliasing, RoundedAlbedoExplainsNothing) {
    Wall wall;
    wall.light(even, 0.5f);
    const double error = mean_square(wall.denoised(), even);
    std::vector<float> albedo[2] = {wall.albedo, wall.albedo};
    std::mt19937 random(3);
    for (std::vector<float>& half : albedo) {
        for (float& value : half)
            value += 1e-6f * (static_cast<float>(random() % 3) - 1);
    }
    DenoiseInput input = wall.input();
    input.albedo = {albedo[0], albedo[1]};
    std::vector<float> out = wall.mean();
    denoise(input, std::vector<LightImage>{{out, 3}});
    EXPECT_LT(mean_square(out, even), 1.02 * error);
}

TEST(Aliasing, WithoutNoiseThereIsNone) {
    const NoisyPair albedo(1), normal(2);
    Rgb color[2] = {albedo.halves[0], albedo.halves[0]};
    EXPECT_EQ(mean_of(aliasing_share(color, albedo.halves, normal.halves)), 0);
}

/// An unlit drawing of slanted stripes, whose edges' errors in the halves mostly cancel.
TEST(Aliasing, StratifiedEdgesDoNotGetWorse) {
    const auto stripes = [](int x, int y) {
        const float along = 0.31f * static_cast<float>(x) + 0.17f * static_cast<float>(y);
        return std::clamp(3 * std::sin(along) + 0.5f, 0.05f, 1.0f);
    };
    Wall wall;
    wall.light(stripes, 0);
    std::mt19937 random(5);
    std::normal_distribution<float> spread(0, 0.03f);
    for (size_t i = 0; i < pixels; ++i) {
        const float value = stripes(static_cast<int>(i % width), static_cast<int>(i / width));
        if (value == 0.05f || value == 1) continue;
        const float error = std::clamp(spread(random), -value, value);
        for (size_t c = 0; c < 3; ++c) {
            wall.halves[0][3 * i + c] += error;
            wall.halves[1][3 * i + c] -= 0.6f * error;
        }
    }
    DenoiseInput input = wall.input();
    input.albedo = {wall.halves[0], wall.halves[1]};
    std::vector<float> out = wall.mean();
    denoise(input, std::vector<LightImage>{{out, 3}});
    EXPECT_LT(mean_square(out, stripes), 1.1 * mean_square(wall.mean(), stripes));
}

}  // namespace
}  // namespace obscura
