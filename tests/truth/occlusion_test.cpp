// tests/truth/occlusion_test.cpp - occlusion textures dim the environment's light, and no other.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/arena_images.h"
#include "support/scene_builder.h"
#include "truth/reference.h"

namespace obscura::test {
namespace occlusion_truth {

constexpr int image_size = 16;
constexpr uint32_t texel_code = 51;  ///< a fifth
constexpr float strength = 0.5f;
constexpr double occlusion = 1 + 0.5 * (51 / 255.0 - 1);
constexpr double tolerance = 0.01;

/// A plate at height y, with an occlusion texture if asked.
void add_plate(SceneBuilder& builder, float y, Material m, bool occluded) {
    if (occluded) {
        m.occlusion_texture.texture = 0;
        m.occlusion_strength = strength;
    }
    builder.quad({-2, y, 2}, {4, 0, 0}, {0, 0, -4}, builder.material(m));
    Scene& scene = builder.scene();
    scene.primitives.back().uv_base[0] =
        -2 * static_cast<int32_t>(scene.primitives.size() - 1) * 4;  // all see the same four
}

Scene finish(SceneBuilder& builder) {
    Scene scene = builder.take();
    add_image(scene.textures,
              2,
              pack_sampler(Wrap::repeat, Wrap::repeat, false, false, MipMode::linear, false),
              [](int, int) { return texel_code | 0xFFFFFF00U; });
    scene.attributes.assign(12, 0.0f);
    return scene;
}

Material matte(float grey) {
    Material m;
    m.metallic = 0;
    std::fill_n(m.base_color, 3, grey);
    return m;
}

struct Lit {
    Material material;
    bool environment = true;
    bool lamp = false;
    int strategies = 3;
    Integrator integrator = Integrator::path;
};

/// The mean radiance of a plate under white light from all around, or a lamp, or both.
double plate(const Lit& lit, bool occluded) {
    SceneBuilder builder;
    add_plate(builder, 0, lit.material, occluded);
    if (lit.lamp) {
        PunctualLight lamp;
        lamp.position[1] = 1;
        builder.scene().lights.push_back(lamp);
    }
    LightingOptions lighting;
    lighting.environment = constant_environment(lit.environment ? 1.0f : 0.0f);
    RenderOptions options;
    options.width = options.height = image_size;
    options.samples_per_pixel = 256;
    options.strategies = lit.strategies;
    options.integrator = lit.integrator;
    const Camera camera = look_at({0, 1, 1.5f}, {0, 0, 0}, 0.2f, image_size, image_size);
    return film_mean(render_scene(finish(builder), lighting, camera, options).film).value;
}

TEST(Occlusion, DimsTheEnvironmentHoweverItIsFound) {
    Material metal;
    metal.roughness = 0.3f;
    Material mirror;
    mirror.roughness = 0;
    for (const Material& material : {matte(0.6f), metal, mirror}) {
        for (const int strategies : {1, 2, 3}) {
            const Lit lit{material, true, false, strategies};
            const double without = plate(lit, false);
            EXPECT_GT(without, 0.05);
            EXPECT_NEAR(plate(lit, true) / without, occlusion, tolerance);
        }
        const Lit cast{material, true, false, 3, Integrator::raycast};
        EXPECT_NEAR(plate(cast, true) / plate(cast, false), occlusion, tolerance);
    }
}

TEST(Occlusion, LeavesLampsAlone) {
    const Lit lit{matte(0.6f), false, true};
    const double without = plate(lit, false);
    EXPECT_GT(without, 0.01);
    EXPECT_NEAR(plate(lit, true), without, 1e-6);
}

TEST(Occlusion, IsThatOfTheSurfaceThatTheLightComesTo) {
    // A ceiling above sees the floor alone: half the light that leaves it comes from below.
    const auto ceiling_seen_from_below = [](bool floor_occluded, bool ceiling_occluded) {
        SceneBuilder builder;
        add_plate(builder, 0, matte(0.8f), floor_occluded);
        Material above = matte(0.8f);
        above.flags |= material_double_sided;
        add_plate(builder, 3, above, ceiling_occluded);
        LightingOptions lighting;
        lighting.environment = constant_environment(1);
        RenderOptions options;
        options.width = options.height = image_size;
        options.samples_per_pixel = 1024;
        const Camera camera = look_at({0, 0.5f, 0.4f}, {0, 3, 0}, 0.2f, image_size, image_size);
        return film_mean(render_scene(finish(builder), lighting, camera, options).film).value;
    };
    const double plain = ceiling_seen_from_below(false, false);
    const double floor = ceiling_seen_from_below(true, false);
    const double ceiling = ceiling_seen_from_below(false, true);
    const double both = ceiling_seen_from_below(true, true);
    // Losses by both are not counted twice: no path is dimmed twice by the same light.
    EXPECT_LT(floor, plain - 0.02);
    EXPECT_LT(ceiling, plain - 0.02);
    EXPECT_NEAR(plain - both, (plain - floor) + (plain - ceiling), 0.004);
    EXPECT_NEAR(both / plain, occlusion, tolerance) << "all light comes to one of them first";
}

}  // namespace occlusion_truth
}  // namespace obscura::test
