// tests/render/part_mean_test.cpp - halves of the samples: their mean is the image.
// SPDX-License-Identifier: Apache-2.0
#include "film/layers.h"

#include <gtest/gtest.h>

#include "support/scene_builder.h"
#include <cmath>

namespace obscura::test {
namespace {

constexpr int quad_width = 20;
constexpr int quad_height = 12;

RenderResult render_quad(int samples, std::vector<Layer> layers, int tile_size) {
    SceneBuilder builder;
    Material red;
    red.base_color[0] = 0.75f;
    red.base_color[1] = 0.5f;
    red.base_color[2] = 0.25f;
    builder.quad({-0.6f, -0.4f, 0}, {1, 0, 0}, {0, 1, 0}, builder.material(red));
    RenderOptions options;
    options.width = quad_width;
    options.height = quad_height;
    options.samples_per_pixel = samples;
    options.tile_size = tile_size;
    options.layers = std::move(layers);
    const Camera camera = look_at({0, 0, 3}, {0, 0, 0}, 0.9f, quad_width, quad_height);
    return render_scene(builder.take(), {constant_environment(1)}, camera, options);
}

std::vector<Layer> halves_with_run(size_t run) {
    std::vector<Layer> layers = denoising_layers();
    for (Layer& layer : layers) {
        if (auto* mean = std::get_if<PartMean>(&layer.source)) mean->run = run;
    }
    return layers;
}

TEST(PartMean, RunsLeaveSamplesToBothHalves) {
    EXPECT_EQ(half_run(2), 1U);
    EXPECT_EQ(half_run(8), 4U);
    EXPECT_EQ(half_run(15), 4U);
    EXPECT_EQ(half_run(16), 8U);
    EXPECT_EQ(half_run(4096), 8U);
    const PartMean first{{}, SamplePart::first_half, 8};
    const PartMean second{{}, SamplePart::second_half, 8};
    EXPECT_EQ(samples_in(first, 27), 16U);
    EXPECT_EQ(samples_in(second, 27), 11U);
    EXPECT_EQ(samples_in(PartMean{}, 27), 27U);
}

TEST(PartMean, HalvesAddUpToTheBeautyWhichDoesNotChange) {
    for (const int samples : {16, 27}) {
        const Film alone = render_quad(samples, {}, 16).film;
        const Film film = render_quad(samples, halves_with_run(8), 16).film;
        EXPECT_EQ(alone.pixels, film.pixels);
        const auto first =
            static_cast<double>(samples_in({{}, SamplePart::first_half, 8}, samples));
        const double share = first / samples;
        bool differs = false;
        for (size_t i = 0; i < 3 * quad_width * quad_height; ++i) {
            const auto one = static_cast<double>(film.layers[0].pixels[i]);
            const auto other = static_cast<double>(film.layers[1].pixels[i]);
            const auto beauty = static_cast<double>(film.pixels[i / 3 * 4 + i % 3]);
            EXPECT_NEAR(share * one + (1 - share) * other, beauty, 2e-6 * beauty);
            differs |= one != other;
        }
        EXPECT_TRUE(differs);
    }
}

/// A batch holds some of a pixel's samples, or those of some pixels: by the size of the tile.
TEST(PartMean, BatchesDoNotMatter) {
    const Film small = render_quad(300, halves_with_run(8), 4).film;
    const Film large = render_quad(300, halves_with_run(8), 64).film;
    for (size_t k = 0; k < small.layers.size(); ++k)
        EXPECT_EQ(small.layers[k].pixels, large.layers[k].pixels) << small.layers[k].layer.name;
}

}  // namespace
}  // namespace obscura::test
