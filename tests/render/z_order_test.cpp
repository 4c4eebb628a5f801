// tests/render/z_order_test.cpp - with few samples, the errors of neighbouring pixels cancel.
// SPDX-License-Identifier: Apache-2.0
#include "render/integrators.h"

#include <gtest/gtest.h>

#include "support/scene_builder.h"
#include <cmath>

namespace obscura::test {
namespace {

constexpr int side = 128;
constexpr int block = 8;

/// A white floor below a lamp of its size, of which a narrow beam shows one point.
Film lit_floor(int samples, std::optional<AdaptiveOptions> adaptive) {
    SceneBuilder builder;
    Material white;
    white.metallic = 0;
    white.roughness = 1;
    Material lamp;
    std::fill_n(lamp.emission, 3, 1.0f);
    builder.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, builder.material(white));
    builder.quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, builder.material(lamp));
    RenderOptions options;
    options.width = options.height = side;
    options.samples_per_pixel = samples;
    options.integrator = Integrator::direct;
    options.adaptive = adaptive;
    const Camera camera = look_at({0, 0.9f, 0.1f}, {0, 0, 0}, 1e-3f, side, side);
    return render_scene(builder.take(), {}, camera, options).film;
}

/// Variance of the means of blocks of pixels, over that of independent pixels.
double ratio_of_variances(const Film& film) {
    constexpr int blocks = side / block;
    std::vector<double> means(size_t{blocks} * blocks, 0.0);
    double sum = 0;
    double squares = 0;
    for (size_t i = 0; i < size_t{side} * side; ++i) {
        const auto value = static_cast<double>(film.pixels[4 * i]);
        sum += value;
        squares += value * value;
        means[i / side / block * blocks + i % side / block] += value / (block * block);
    }
    const double mean = sum / (side * side);
    double of_means = 0;
    for (const double one : means)
        of_means += (one - mean) * (one - mean) / static_cast<double>(means.size());
    return of_means * block * block / (squares / (side * side) - mean * mean);
}

TEST(ZOrder, WithFewSamplesErrorsOfNeighboursCancel) {
    EXPECT_LT(ratio_of_variances(lit_floor(1, {})), 0.15);
    EXPECT_LT(ratio_of_variances(lit_floor(4, {})), 0.2);
    EXPECT_LT(ratio_of_variances(lit_floor(16, {})), 0.4);
}

TEST(ZOrder, WithManyOrAdaptivelyPixelsAreIndependent) {
    EXPECT_NEAR(ratio_of_variances(lit_floor(min_samples_to_go_on, {})), 1, 0.3);
    const AdaptiveOptions never{.noise_target = 1e-6, .min_samples = 4};
    EXPECT_NEAR(ratio_of_variances(lit_floor(4, never)), 1, 0.3);
}

TEST(ZOrder, TheMeanStays) {
    const auto mean = [](const Film& film) {
        double sum = 0;
        for (size_t i = 0; i < film.pixels.size(); i += 4)
            sum += static_cast<double>(film.pixels[i]);
        return 4 * sum / static_cast<double>(film.pixels.size());
    };
    const double expected = mean(lit_floor(256, {}));
    EXPECT_NEAR(mean(lit_floor(1, {})) / expected, 1, 1e-3);
    EXPECT_NEAR(mean(lit_floor(5, {})) / expected, 1, 1e-3);
}

/// Part of a picture that has corners of four blocks, and pixels beyond its edges.
Film part_of_floor(const PixelRect& crop, int tile_size) {
    RenderOptions options;
    options.width = 150;
    options.height = 100;
    options.samples_per_pixel = 5;
    options.tile_size = tile_size;
    options.crop = crop;
    const Camera camera = look_at({0, 0.9f, 1}, {0, 0, 0}, 0.7f, options.width, options.height);
    SceneBuilder builder;
    builder.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, builder.material({}));
    LightingOptions light;
    light.environment = constant_environment(0.5f);
    return render_scene(builder.take(), light, camera, options).film;
}

TEST(ZOrder, TilesAndCropsDoNotChangeABit) {
    const PixelRect all{-5, -3, 160, 106};
    const Film whole = part_of_floor(all, 16);
    EXPECT_EQ(whole.pixels, part_of_floor(all, 48).pixels);
    const PixelRect crop{58, 60, 13, 9};
    const Film part = part_of_floor(crop, 16);
    for (int y = 0; y < crop.height; ++y) {
        for (int x = 0; x < crop.width; ++x) {
            const size_t in_whole = pixel_index(whole, crop.x + x, crop.y + y);
            const size_t in_part = pixel_index(part, crop.x + x, crop.y + y);
            for (size_t c = 0; c < 3; ++c)
                ASSERT_EQ(whole.pixels[4 * in_whole + c], part.pixels[4 * in_part + c]);
        }
    }
}

TEST(ZOrder, EveryPixelHasRoomForItsSamples) {
    RenderOptions options;
    for (const auto& [samples, bits] :
         {std::pair{1, 0}, {2, 1}, {3, 2}, {16, 4}, {17, 5}, {63, 6}, {64, -1}, {4096, -1}}) {
        options.samples_per_pixel = samples;
        EXPECT_EQ(z_order_bits(options), bits) << samples;
    }
}

}  // namespace
}  // namespace obscura::test
