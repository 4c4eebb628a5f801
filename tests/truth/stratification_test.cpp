// tests/truth/stratification_test.cpp - how fast noise falls: well stratified samples beat chance.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/scene_builder.h"

namespace obscura::test {
namespace stratification_truth {

/// A grey floor under lamps of two triangles each, where nothing hides them.
Scene lit_floor(int lamps) {
    SceneBuilder builder;
    Material floor;
    floor.metallic = 0;
    floor.roughness = 1;
    floor.base_color[0] = 0.5f;
    Material lamp;
    std::fill_n(lamp.emission, 3, 5.0f);
    builder.quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, builder.material(floor));
    const int32_t glows = builder.material(lamp);
    for (int k = 0; k < lamps; ++k) {
        const float x = static_cast<float>(k) - 0.5f * static_cast<float>(lamps);
        builder.quad({x, 1.5f, -0.5f}, {0.8f, 0, 0}, {0, 0, 0.8f}, glows);
    }
    return builder.take();
}

/// Variance of a pixel of the direct light between independent images, by the mean over pixels.
double pixel_variance(int lamps, int samples) {
    constexpr int runs = 6;
    RenderOptions options;
    options.width = options.height = 16;
    options.samples_per_pixel = samples;
    options.max_bounces = 0;
    std::vector<UnsetArray<float>> images;
    for (int run = 0; run < runs; ++run) {
        options.seed = static_cast<uint64_t>(run);
        const Camera camera = look_at({0, 0.9f, 1.2f}, {0, 0, 0}, 0.5f, 16, 16);
        images.push_back(render_scene(lit_floor(lamps), {}, camera, options).film.pixels);
    }
    double sum = 0;
    for (size_t i = 0; i < images[0].size(); i += 4) {
        double mean = 0;
        double squares = 0;
        for (const auto& image : images) {
            mean += static_cast<double>(image[i]) / runs;
            squares += static_cast<double>(image[i]) * static_cast<double>(image[i]);
        }
        sum += (squares - runs * mean * mean) / (runs - 1);
    }
    return sum / static_cast<double>(images[0].size() / 4);
}

/// With random samples the variance falls to a sixteenth; numbers that choose the light apart from
/// the place on it would be no better than that.
TEST(Stratification, SixteenTimesTheSamplesGiveFarLessThanASixteenthOfTheVariance) {
    for (const int lamps : {1, 3}) {
        const double few = pixel_variance(lamps, 16);
        const double many = pixel_variance(lamps, 256);
        EXPECT_GT(few, 0) << "nothing is random here";
        EXPECT_LT(many, few / 40) << lamps << " lamps";
    }
}

}  // namespace stratification_truth
}  // namespace obscura::test
