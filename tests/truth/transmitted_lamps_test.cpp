// tests/truth/transmitted_lamps_test.cpp - lamps close behind surfaces that let light through.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "truth/dielectric_scene.h"
#include <numbers>

namespace obscura::test {
namespace transmitted_lamps_truth {

constexpr float half_lamp = 0.1f;
constexpr float glow = 10;

/// Paper: all light passes it, diffusely; nothing is reflected.
MaterialLayers paper() {
    MaterialLayers layers;
    layers.diffuse_transmission = 1;
    layers.specular = 0;
    return layers;
}

Material surface_with_layers(float roughness) {
    Material m;
    m.metallic = 0;
    m.roughness = roughness;
    m.layers = 0;
    return m;
}

Material lamp() {
    Material m;
    m.metallic = 0;
    std::fill_n(m.base_color, 3, 0.0f);
    std::fill_n(m.emission, 3, glow);
    return m;
}

void add_lamp(SceneBuilder& builder, float depth, bool in_pieces) {
    const int pieces = in_pieces ? 8 : 1;  // 128 triangles, which the light tree chooses among
    const float side = 2 * half_lamp / static_cast<float>(pieces);
    const int32_t material = builder.material(lamp());
    for (int i = 0; i < pieces * pieces; ++i) {
        const auto x = static_cast<float>(i % pieces);
        const auto y = static_cast<float>(i / pieces);
        builder.quad({x * side - half_lamp, y * side - half_lamp, -depth},
                     {side, 0, 0},
                     {0, side, 0},
                     material);
    }
}

Mean seen_from_front(Scene scene) {
    constexpr int side = 8;
    RenderOptions options;
    options.width = options.height = side;
    options.samples_per_pixel = 1024;
    const Camera camera = look_at({0, 0, 2}, {0, 0, 0}, 1e-4f, side, side);
    return film_mean(render_scene(std::move(scene), {}, camera, options).film);
}

/// Irradiance of the origin, facing the lamp, by its grid's midpoints.
double irradiance(double depth) {
    constexpr int cells = 400;
    const double side = 2.0 * static_cast<double>(half_lamp) / cells;
    double sum = 0;
    for (int i = 0; i < cells * cells; ++i) {
        const double x = (i % cells + 0.5) * side - static_cast<double>(half_lamp);
        const double y = (i / cells + 0.5) * side - static_cast<double>(half_lamp);
        const double r2 = x * x + y * y + depth * depth;
        sum += depth * depth / (r2 * r2) * side * side;
    }
    return static_cast<double>(glow) * sum;
}

TEST(TransmittedLamps, PaperShowsALampBehindIt) {
    for (const bool in_pieces : {false, true}) {
        for (const float depth : {0.01f, 0.05f, 0.2f, 1.0f}) {
            for (const float half : {0.1f, 5.0f}) {
                SceneBuilder builder;
                builder.quad({-half, -half, 0},
                             {2 * half, 0, 0},
                             {0, 2 * half, 0},
                             builder.material(surface_with_layers(1)));
                add_lamp(builder, depth, in_pieces);
                Scene scene = builder.take();
                scene.layers = {paper()};
                const double expected = irradiance(static_cast<double>(depth)) / std::numbers::pi;
                const Mean mean = seen_from_front(std::move(scene));
                EXPECT_NEAR(mean.value / expected, 1, 5 * mean.error / expected + 1e-3)
                    << depth << " m behind paper of " << half << ", " << in_pieces;
            }
        }
    }
}

/// What a single-sided lamp lets through does not come from itself.
TEST(TransmittedLamps, LampsDoNotShineThroughThemselves) {
    MaterialLayers half = paper();
    half.diffuse_transmission = 0.5f;
    MaterialLayers frosted;
    frosted.transmission = 0.6f;
    for (const MaterialLayers& layers : {half, frosted}) {
        SceneBuilder builder;
        Material m = surface_with_layers(0.6f);
        std::fill_n(m.emission, 3, glow);
        builder.sphere({0, 0, 0}, 0.5f, 24, builder.material(m));
        Scene scene = builder.take();
        scene.layers = {layers};
        EXPECT_NEAR(seen_from_front(std::move(scene)).value, static_cast<double>(glow), 1e-4);
    }
}

/// A ball of index 1 that glows: seen through its front, its back is dark.
TEST(TransmittedLamps, SingleSidedSolidsGlowOutwardsAlone) {
    MaterialLayers clear;
    clear.transmission = 1;
    clear.ior = 1;
    clear.medium = 1;
    for (const bool in_front : {true, false}) {
        SceneBuilder builder;
        Material m = surface_with_layers(0);
        m.flags = material_double_sided;
        if (in_front) m.flags |= material_glows_in_front;
        std::fill_n(m.base_color, 3, 1.0f);
        std::fill_n(m.emission, 3, glow);
        builder.sphere({0, 0, 0}, 0.5f, 24, builder.material(m));
        Scene scene = builder.take();
        scene.layers = {clear};
        number_media(scene);
        const double expected = static_cast<double>(glow) * (in_front ? 1 : 2);
        EXPECT_NEAR(seen_from_front(std::move(scene)).value, expected, 1e-3);
    }
}

}  // namespace transmitted_lamps_truth
}  // namespace obscura::test
