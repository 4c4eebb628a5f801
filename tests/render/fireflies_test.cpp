// tests/render/fireflies_test.cpp - options against fireflies: limits, caustics, regularization.
// SPDX-License-Identifier: Apache-2.0
#include "stages/contribution_limit.h"

#include <gtest/gtest.h>

#include "support/thin_wall_scenes.h"

namespace obscura::test {
namespace {

constexpr int fireflies_side = 16;

Material two_sided(float base, float roughness, float metallic) {
    Material m;
    std::fill_n(m.base_color, 3, base);
    m.roughness = roughness;
    m.metallic = metallic;
    m.flags = material_double_sided;
    return m;
}

/// The floor under a lamp, beside a wall.
Scene floor_by_a_wall(const Material& wall, const MaterialLayers* layers = nullptr) {
    ThinWallScene scene;
    const int32_t index =
        layers != nullptr ? scene.add(wall, *layers) : scene.builder.material(wall);
    scene.builder.quad({0.5f, 0, -1}, {0, 2, 0}, {0, 0, 2}, index);
    Material lamp = two_sided(0, 1, 0);
    std::fill_n(lamp.emission, 3, 5.0f);
    scene.builder.quad({-0.5f, 1.5f, -0.5f}, {0.5f, 0, 0}, {0, 0, 1}, scene.builder.material(lamp));
    scene.light(lamp_at({-0.3f, 1, 0.2f}));
    return scene.take();
}

RenderOptions few_samples() {
    RenderOptions options;
    options.width = options.height = fireflies_side;
    options.samples_per_pixel = 64;
    options.max_bounces = 3;
    return options;
}

/// The pixels of a view of the floor alone.
std::vector<float> floor_pixels(Scene scene, const RenderOptions& options) {
    const Camera camera = look_at({0, 1, 0.8f}, {0, 0, 0}, 0.2f, fireflies_side, fireflies_side);
    const Film film = render_scene(std::move(scene), {}, camera, options).film;
    return {film.pixels.begin(), film.pixels.end()};
}

double sum_of(const std::vector<float>& pixels) {
    double sum = 0;
    for (size_t i = 0; i < pixels.size(); i += 4)
        sum += static_cast<double>(pixels[i]);
    return sum;
}

void expect_near(const std::vector<float>& a, const std::vector<float>& b, float tolerance) {
    ASSERT_EQ(a.size(), b.size());
    EXPECT_GT(sum_of(b), 0);
    for (size_t i = 0; i < a.size(); ++i)
        ASSERT_NEAR(a[i], b[i], tolerance * (1e-3f + std::fabs(b[i]))) << i;
}

TEST(Clamping, TheGreatestChannelKeepsToTheLimitAndTheColourStays) {
    const Vec3f light{6, 3, 0.5f};
    const Vec3f limited = limit_contribution(light, 2.0f);
    EXPECT_FLOAT_EQ(limited.x, 2.0f);
    EXPECT_FLOAT_EQ(limited.y, 1.0f);
    EXPECT_FLOAT_EQ(limited.z, 0.5f / 3);
    EXPECT_EQ(limit_contribution(light, 7.0f).y, 3.0f) << "below the limit";
    EXPECT_EQ(limit_contribution(light, 0.0f).x, 6.0f) << "no limit";
    EXPECT_EQ(limit_contribution(Vec3f{0, 0, 0}, 1.0f).x, 0.0f);
}

TEST(Clamping, WithoutIndirectLightTheDirectLightIsLeft) {
    const Material wall = two_sided(0.8f, 0.2f, 1);
    RenderOptions options = few_samples();
    options.clamp_indirect = 1e-9;
    const std::vector<float> limited = floor_pixels(floor_by_a_wall(wall), options);
    options.clamp_indirect = 0;
    EXPECT_GT(sum_of(floor_pixels(floor_by_a_wall(wall), options)), 1.01 * sum_of(limited));
    options.integrator = Integrator::direct;
    expect_near(limited, floor_pixels(floor_by_a_wall(wall), options), 1e-5f);
}

TEST(Clamping, WhatTheCameraSeesItselfStays) {
    RenderOptions options = few_samples();
    options.clamp_direct = options.clamp_indirect = 1e-9;
    const std::vector<float> dark =
        floor_pixels(floor_by_a_wall(two_sided(0.8f, 0.2f, 1)), options);
    for (size_t i = 0; i < dark.size(); i += 4)
        ASSERT_LT(dark[i], 1e-8f);
    const Camera up =
        look_at({-0.25f, 0.5f, 0}, {-0.25f, 1.5f, 0}, 0.2f, fireflies_side, fireflies_side);
    const Film film = render_scene(floor_by_a_wall(two_sided(0.8f, 1, 0)), {}, up, options).film;
    EXPECT_FLOAT_EQ(film.pixels[0], 5.0f);
}

/// A surface that nothing leaves.
Material black_wall() {
    Material m = two_sided(0, 1, 0);
    m.flags |= material_unlit;
    return m;
}

TEST(Caustics, OffMakesSmoothWallsBlackToTheFloor) {
    RenderOptions options = few_samples();
    const std::vector<float> black = floor_pixels(floor_by_a_wall(black_wall()), options);
    MaterialLayers glass = glass_layers();
    glass.clearcoat = 1;
    for (const bool layered : {false, true}) {
        Material wall = layered ? glass_material() : two_sided(0.9f, 0, 1);
        // Of index 1.5 and rough behind its coat, no smooth thin wall: all of it is caustics.
        if (layered) wall.roughness = 0.4f;
        const MaterialLayers* const layers = layered ? &glass : nullptr;
        options.caustics = false;
        expect_near(floor_pixels(floor_by_a_wall(wall, layers), options), black, 1e-5f);
        options.caustics = true;
        EXPECT_GT(sum_of(floor_pixels(floor_by_a_wall(wall, layers), options)),
                  1.001 * sum_of(black));
    }
}

TEST(Caustics, OffLeavesRoughSurfacesAndMirrorsBeforeTheEye) {
    RenderOptions options = few_samples();
    const auto both = [&](const Material& wall, const Camera& camera) {
        std::vector<float> out[2];
        for (const bool on : {false, true}) {
            options.caustics = on;
            const Film film = render_scene(floor_by_a_wall(wall), {}, camera, options).film;
            out[on ? 1 : 0] = {film.pixels.begin(), film.pixels.end()};
        }
        expect_near(out[0], out[1], 1e-6f);
    };
    both(two_sided(0.9f, 0.6f, 1),
         look_at({0, 1, 0.8f}, {0, 0, 0}, 0.2f, fireflies_side, fireflies_side));
    // The mirror shows the floor; one more bounce would come to it again.
    options.max_bounces = 1;
    both(two_sided(0.9f, 0, 1),
         look_at({0, 0.6f, 0}, {0.5f, 0.3f, 0}, 0.2f, fireflies_side, fireflies_side));
}

TEST(Caustics, OffLeavesWhatComesStraightThroughWindows) {
    RenderOptions options = few_samples();
    const auto under_glass = [&](bool caustics) {
        ThinWallScene scene;
        MaterialLayers clear = glass_layers();
        clear.ior = 1;
        scene.pane(0.7f, scene.add(glass_material(), clear));
        scene.light(lamp_at({0, 1.5f, 0}));
        options.caustics = caustics;
        return floor_pixels(scene.take(), options);
    };
    expect_near(under_glass(false), under_glass(true), 1e-6f);
}

TEST(Regularization, MirrorsAreAsWideAsOneOfTheLeastWidth) {
    // Width 0.001 becomes 0.1, which is roughness sqrt(0.1). The camera sees the floor alone.
    RenderOptions options = few_samples();
    options.max_bounces = 1;
    const auto lit = [&](float roughness, bool regularize, const MaterialLayers* layers) {
        options.regularize = regularize;
        return floor_pixels(floor_by_a_wall(two_sided(0.9f, roughness, 1), layers), options);
    };
    MaterialLayers coated;
    coated.clearcoat = 0.8f;
    MaterialLayers widened = coated;
    widened.clearcoat_roughness = std::sqrt(0.1f);
    expect_near(lit(0, true, nullptr), lit(std::sqrt(0.1f), false, nullptr), 1e-3f);
    expect_near(lit(0, true, &coated), lit(std::sqrt(0.1f), false, &widened), 1e-3f);
    // 0.16 becomes 0.3; from there on nothing changes.
    expect_near(lit(0.4f, true, nullptr), lit(std::sqrt(0.3f), false, nullptr), 1e-3f);
    expect_near(lit(0.6f, true, nullptr), lit(0.6f, false, nullptr), 1e-5f);
}

}  // namespace
}  // namespace obscura::test
