// tests/render/prepared_scene_test.cpp - instruction sets, and how an environment is sampled.
// SPDX-License-Identifier: Apache-2.0
#include "render/prepared_scene.h"

#include <gtest/gtest.h>

#include "support/scene_builder.h"

namespace obscura::test {
namespace {

TEST(PreparedScene, AnInstructionSetThatTheProcessorLacksIsRefused) {
    const auto no_processor_has_it = static_cast<Isa>(99);
    SceneBuilder builder;
    builder.quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, builder.material({}));
    Log log(Verbosity::quiet);
    const auto prepared = PreparedScene::create(builder.take(), {}, no_processor_has_it, log);
    ASSERT_FALSE(prepared);
    EXPECT_EQ(prepared.error().id, "E-ISA");
    EXPECT_EQ(prepared.error().code, ExitCode::unsupported);
}

/// How much denser light samples are in a sky of 2 than on the ground of 1 below it.
double sky_over_ground(const PreparedScene& scene) {
    const EnvironmentView view = scene.impl().environment->view();
    return environment_pdf(view, normalize(Vec3d{0.3, 0.9, 0.2})) /
           environment_pdf(view, normalize(Vec3d{0.3, -0.9, 0.2}));
}

/// MIS compensation makes 5 of 2; shadow catchers have light samples alone.
TEST(PreparedScene, CatchersSampleTheEnvironmentByItsRadiance) {
    const auto scene_with = [](uint8_t flags, bool of_instance) {
        SceneBuilder builder;
        builder.quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, builder.material({}));
        Scene scene = builder.take();
        scene.visibility.primitives.assign(scene.primitives.size(), of_instance ? 0 : flags);
        scene.visibility.instances.assign(std::max<size_t>(scene.instances.size(), 1),
                                          of_instance ? flags : 0);
        return scene;
    };
    LightingOptions sky;
    sky.environment = ImageRgb32f{};
    sky.environment->width = 16;
    sky.environment->height = 8;
    for (int i = 0; i < 16 * 8 * 3; ++i)
        sky.environment->pixels.push_back(i < 16 * 4 * 3 ? 2.0F : 1.0F);
    LightingOptions over_ground = sky;
    over_ground.catcher_ground = true;
    Log log(Verbosity::quiet);
    const auto density = [&](Scene scene, const LightingOptions& lighting) {
        return sky_over_ground(
            PreparedScene::create(std::move(scene), lighting, Isa::automatic, log).value());
    };
    EXPECT_NEAR(density(scene_with(0, false), sky), 5, 1e-4);
    EXPECT_NEAR(density(scene_with(visibility_no_shadow, false), sky), 5, 1e-4);
    EXPECT_NEAR(density(scene_with(visibility_catcher, false), sky), 2, 1e-4);
    EXPECT_NEAR(density(scene_with(visibility_catcher, true), sky), 2, 1e-4);
    EXPECT_NEAR(density(scene_with(0, false), over_ground), 2, 1e-4);

    // The environment is the same and the catcher new: its table is made again.
    auto prepared = PreparedScene::create(scene_with(0, false), sky, Isa::automatic, log).value();
    ASSERT_TRUE(prepared.update(scene_with(visibility_catcher, false), sky, log));
    EXPECT_NEAR(sky_over_ground(prepared), 2, 1e-4);
}

TEST(PreparedScene, AnEnvironmentThatIsTurnedIsThatOfItsOwn) {
    const auto scene = [] {
        SceneBuilder builder;
        builder.quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, builder.material({}));
        return builder.take();
    };
    LightingOptions lighting;
    lighting.environment = constant_environment(1);
    for (int i = 0; i < 30; ++i)  // a lamp in one direction
        lighting.environment->pixels[static_cast<size_t>(3 * 16 * 3 + i)] = 50;
    Log log(Verbosity::quiet);
    auto turned = PreparedScene::create(scene(), lighting, Isa::automatic, log).value();
    lighting.environment_rotation_deg = 70;
    ASSERT_TRUE(turned.update(scene(), lighting, log));
    const auto anew = PreparedScene::create(scene(), lighting, Isa::automatic, log).value();
    const EnvironmentView a = turned.impl().environment->view();
    const EnvironmentView b = anew.impl().environment->view();
    for (int i = 0; i < 100; ++i) {
        const Vec3d direction =
            normalize(Vec3d{std::cos(0.7 * i), 0.1 * (i % 9), std::sin(0.7 * i)});
        EXPECT_EQ(environment_pdf(a, direction), environment_pdf(b, direction));
    }
    lighting.environment_rotation_deg = std::nan("");
    EXPECT_FALSE(turned.update(scene(), lighting, log));
}

}  // namespace
}  // namespace obscura::test
