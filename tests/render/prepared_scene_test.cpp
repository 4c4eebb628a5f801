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
    const EnvironmentView view = scene.impl().environment_view();
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
    ImageRgb32f bright_above{16, 8, {}};
    for (int i = 0; i < 16 * 8 * 3; ++i)
        bright_above.pixels.push_back(i < 16 * 4 * 3 ? 2.0F : 1.0F);
    LightingOptions sky;
    sky.environment = shared(std::move(bright_above));
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
    ImageRgb32f with_lamp = *constant_environment(1);
    for (int i = 0; i < 30; ++i)  // in one direction
        with_lamp.pixels[static_cast<size_t>(3 * 16 * 3 + i)] = 50;
    LightingOptions lighting;
    lighting.environment = shared(std::move(with_lamp));
    Log log(Verbosity::quiet);
    auto turned = PreparedScene::create(scene(), lighting, Isa::automatic, log).value();
    lighting.environment_rotation_deg = 70;
    ASSERT_TRUE(turned.update(scene(), lighting, log));
    const ImageRgb32f& map = *lighting.environment;
    const EnvironmentImage image{map.width, map.height, map.pixels.data()};
    const auto anew = EnvironmentTable::create(image, 1, 70).value();
    const auto straight = EnvironmentTable::create(image, 1, 0).value();
    int moved = 0;
    for (int i = 0; i < 100; ++i) {
        const Vec3d direction =
            normalize(Vec3d{std::cos(0.7 * i), 0.1 * (i % 9), std::sin(0.7 * i)});
        const auto density = [&](const EnvironmentView& view) {
            return environment_pdf(view, direction);
        };
        EXPECT_EQ(density(turned.impl().environment_view()), density(anew.view()));
        moved += density(anew.view()) != density(straight.view()) ? 1 : 0;
    }
    EXPECT_GT(moved, 10);
    lighting.environment_rotation_deg = std::nan("");
    EXPECT_FALSE(turned.update(scene(), lighting, log));
}

TEST(PreparedScene, ScenesThatFollowHaveTheTableOfOneEnvironment) {
    const auto scene = [] {
        SceneBuilder builder;
        builder.quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, builder.material({}));
        return builder.take();
    };
    Log log(Verbosity::quiet);
    LightingOptions lighting;
    lighting.environment = constant_environment(1);
    lighting.environments = std::make_shared<EnvironmentCache>();
    const auto table_of = [&](const LightingOptions& light) {
        const auto prepared = PreparedScene::create(scene(), light, Isa::automatic, log).value();
        return prepared.impl().environment;
    };
    const auto first = table_of(lighting);
    LightingOptions turned = lighting;
    turned.environment_rotation_deg = 30;
    EXPECT_EQ(table_of(turned), first);
    LightingOptions studio;
    studio.environments = lighting.environments;
    const auto of_studio = table_of(studio);
    EXPECT_NE(of_studio, first);
    EXPECT_EQ(table_of(lighting), first) << "each has its own";
    EXPECT_EQ(table_of(studio), of_studio);
    LightingOptions brighter = lighting;
    brighter.environment_intensity = 2;
    const auto bright = table_of(brighter);
    EXPECT_DOUBLE_EQ(bright->power(), 2 * first->power());
    LightingOptions other = lighting;
    other.environment = constant_environment(1);
    EXPECT_NE(table_of(other), first);
}

TEST(PreparedScene, TablesOfEnvironmentsGoWithTheirImages) {
    EnvironmentCache cache;
    const EnvironmentSource other{constant_environment(2)};
    std::weak_ptr<const EnvironmentTable> dim, bright;
    auto image = constant_environment(1);
    dim = cache.table({image, 1}, "sky").value();
    EXPECT_FALSE(dim.expired());
    bright = cache.table({image, 2}, "sky").value();
    EXPECT_TRUE(dim.expired()) << "the image has another table";
    ASSERT_TRUE(cache.table(other, "other"));
    EXPECT_FALSE(bright.expired()) << "somebody holds the image";
    image.reset();
    ASSERT_TRUE(cache.table({nullptr}, "studio"));
    EXPECT_TRUE(bright.expired());
    const auto used = cache.table(other, "other").value();
    EXPECT_TRUE(cache.drop_unused()) << "the studio's";
    EXPECT_FALSE(cache.drop_unused());
    EXPECT_EQ(cache.table(other, "other").value(), used);
    set_memory_limit(program_memory_bytes + 1000, "this test");
    const auto refused = cache.table({other.image, 3}, "other");
    remove_memory_limit();
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().id, "E-MEM");
    EXPECT_EQ(refused.error().where, "other");
}

}  // namespace
}  // namespace obscura::test
