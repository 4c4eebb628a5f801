// tests/truth/coated_emitters_test.cpp - emission below a clear coat.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/thin_wall_scenes.h"

namespace obscura::test {
namespace coated_emitters_truth {

/// KHR_materials_clearcoat, Emission.
double passes(double coat, double cosine) {
    return 1 - coat * (0.04 + 0.96 * std::pow(1 - cosine, 5));
}

/// Black, and sends out a radiance of 1 from its front.
int32_t add_lamp(ThinWallScene& scene, float coat) {
    Material lamp;
    lamp.metallic = 0;
    lamp.roughness = 1;
    std::fill_n(lamp.base_color, 3, 0.0f);
    std::fill_n(lamp.emission, 3, 1.0f);
    MaterialLayers layers;
    layers.clearcoat = coat;
    return scene.add(lamp, layers);
}

/// A coated square, seen from above at an angle.
double seen(float coat, double cosine) {
    ThinWallScene scene;
    const auto up = static_cast<float>(std::sqrt(1 - cosine * cosine));
    const auto back = static_cast<float>(cosine);
    const Vec3f a{0.2f, 0, 0};
    const Vec3f b{0, 0.2f * up, -0.2f * back};
    scene.builder.quad(Vec3f{0, 0.25f, 0} - (a + b) * 0.5f, a, b, add_lamp(scene, coat));
    return floor_value(scene.take());
}

TEST(CoatedEmitters, AreDarkenedByTheCoatsFresnelReflectance) {
    for (const double cosine : {1.0, 0.8, 0.5}) {
        EXPECT_NEAR(seen(0, cosine), 1, 1e-6);
        EXPECT_NEAR(seen(1, cosine), passes(1, cosine), 2e-3) << cosine;
        EXPECT_NEAR(seen(0.5f, cosine), passes(0.5, cosine), 1e-3) << cosine;
    }
}

/// The floor under a square that faces it, at `place`.
double lit(float coat, const Vec3f& place, float half, const ThinWallView& view) {
    ThinWallScene scene;
    const Vec3f corner = place - Vec3f{half, 0, half};
    scene.builder.quad(corner, {2 * half, 0, 0}, {0, 0, 2 * half}, add_lamp(scene, coat));
    return floor_value(scene.take(), view);
}

TEST(CoatedEmitters, LightTheFloorThroughTheirCoat) {
    ThinWallView view;
    view.samples = 64;
    view.strategies = sample_lights;
    for (const double cosine : {1.0, 0.5}) {
        const auto aside = static_cast<float>(2 * std::sqrt(1 - cosine * cosine) / cosine);
        const double open = lit(0, {aside, 2, 0}, 0.01f, view);
        ASSERT_GT(open, 0);
        EXPECT_NEAR(lit(1, {aside, 2, 0}, 0.01f, view) / open, passes(1, cosine), 1e-3) << cosine;
        EXPECT_NEAR(lit(0.25f, {aside, 2, 0}, 0.01f, view) / open, passes(0.25, cosine), 1e-3);
    }
}

TEST(CoatedEmitters, LightSamplingAndBsdfSamplingAgree) {
    ThinWallView view;
    view.samples = 1024;
    double share[3];
    for (int i = 0; i < 3; ++i) {
        constexpr int strategies[] = {sample_lights, sample_bsdfs, sample_lights | sample_bsdfs};
        view.strategies = strategies[i];
        share[i] = lit(1, {0, 2, 0}, 6, view) / lit(0, {0, 2, 0}, 6, view);
    }
    EXPECT_LT(share[0], 0.95);
    EXPECT_NEAR(share[1], share[0], 2e-3);
    EXPECT_NEAR(share[2], share[0], 2e-3);
}

}  // namespace coated_emitters_truth
}  // namespace obscura::test
