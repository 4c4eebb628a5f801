// tests/truth/emitters_test.cpp - occluders between a lamp and a floor, and the choice of lamps.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/scene_builder.h"
#include "truth/reference.h"

namespace obscura::test {
namespace emitters_truth {

constexpr int image_size = 32;

Material black_material() {
    Material m;
    std::fill_n(m.base_color, 3, 0.0f);
    m.metallic = 0;
    m.flags = material_double_sided;
    return m;
}

Material lamp_material(uint32_t flags, float alpha) {
    Material m = black_material();
    std::fill_n(m.emission, 3, 10.0f);
    m.flags |= flags;
    m.base_color[3] = alpha;
    return m;
}

void add_floor(SceneBuilder& builder) {
    Material white;
    white.metallic = 0;
    builder.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, builder.material(white));
}

/// A square that faces down, at height y.
void add_ceiling(SceneBuilder& builder, float y, float half, const Material& m) {
    builder.quad({-half, y, -half}, {2 * half, 0, 0}, {0, 0, 2 * half}, builder.material(m));
}

Mean floor_radiance(SceneBuilder builder) {
    RenderOptions options;
    options.width = options.height = image_size;
    options.samples_per_pixel = 256;
    const Camera camera = look_at({0, 1, 1.5f}, {0, 0, 0}, 0.2f, image_size, image_size);
    return film_mean(render_scene(builder.take(), {}, camera, options).film);
}

Mean under_a_lamp(uint32_t flags, float alpha) {
    SceneBuilder builder;
    add_floor(builder);
    add_ceiling(builder, 2, 0.5f, lamp_material(flags, alpha));
    return floor_radiance(std::move(builder));
}

TEST(Emitters, AreAsBrightAsTheyAreThere) {
    const Mean whole = under_a_lamp(0, 1.0f);
    const Mean half = under_a_lamp(material_alpha_blend, 0.5f);
    EXPECT_GT(whole.value, 0.1);
    EXPECT_NEAR(half.value, 0.5 * whole.value, 3.0 * half.error + 1.5 * whole.error);
    EXPECT_EQ(under_a_lamp(material_alpha_blend, 0.0f).value, 0.0);
    EXPECT_EQ(under_a_lamp(material_alpha_mask, 0.4f).value, 0.0);
    const Mean kept = under_a_lamp(material_alpha_mask, 0.6f);
    EXPECT_NEAR(kept.value, whole.value, 3.0 * (kept.error + whole.error));
}

TEST(Emitters, ACoverCloseToALampHidesIt) {
    for (const float gap : {1e-2f, 5e-4f, 2e-4f}) {
        SceneBuilder builder;
        add_floor(builder);
        add_ceiling(builder, 10, 0.5f, lamp_material(0, 1.0f));
        add_ceiling(builder, 10 - gap, 0.6f, black_material());
        EXPECT_EQ(floor_radiance(std::move(builder)).value, 0.0) << gap;
    }
}

/// Ambient occlusion on a square with its corners' normals bent outwards, under a lid.
double occlusion_under_a_lid(bool bent) {
    SceneBuilder builder;
    add_floor(builder);
    Scene& scene = builder.scene();
    if (bent) {
        Primitive& floor = scene.primitives.back();
        floor.normal_base = static_cast<int32_t>(scene.attributes.size());
        for (size_t corner = 0; corner < 4; ++corner) {
            const float* p = &scene.positions[3 * corner];
            const Vec3f n = normalize(Vec3f{p[0], 1, p[2]});
            scene.attributes.insert(scene.attributes.end(), {n.x, n.y, n.z});
        }
    }
    add_ceiling(builder, 0.02f, 3.0f, black_material());
    RenderOptions options;
    options.integrator = Integrator::ao;
    options.ao_distance_m = 0.5;
    options.width = options.height = image_size;
    options.samples_per_pixel = 64;
    const Camera camera = look_at({0, 0.015f, 0.02f}, {0, 0, 0}, 0.2f, image_size, image_size);
    return film_mean(render_scene(builder.take(), {}, camera, options).film).value;
}

TEST(Emitters, RaysDoNotStartBeyondALidOnSmoothSurfaces) {
    EXPECT_LT(occlusion_under_a_lid(false), 0.01);
    EXPECT_LT(occlusion_under_a_lid(true), 0.01);
}

TEST(Emitters, ASurfaceThatGlowsInNameOnlyLeavesTheStudioOn) {
    const auto radiance = [](float emission) {
        SceneBuilder builder;
        add_floor(builder);
        Material faint = black_material();
        std::fill_n(faint.emission, 3, emission);
        add_ceiling(builder, 50, 0.5f, faint);
        return floor_radiance(std::move(builder)).value;
    };
    EXPECT_GT(radiance(0.0f), 0.2) << "no lamp";
    EXPECT_GT(radiance(0.01f), 0.2) << "hardly a lamp";
    EXPECT_LT(radiance(1.0f), 0.01) << "a far lamp";
}

}  // namespace emitters_truth
}  // namespace obscura::test
