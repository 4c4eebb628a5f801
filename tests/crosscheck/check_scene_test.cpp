// tests/crosscheck/check_scene_test.cpp - whole checks of small scenes, and their reports.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/check_scene.h"

#include "base/parallel.h"
#include "crosscheck/check_scenes.h"
#include "crosscheck/report_image.h"
#include "crosscheck/report_json.h"
#include "crosscheck/report_table.h"

#include <gtest/gtest.h>

#include "support/points_lines_scenes.h"
#include <gmock/gmock.h>

namespace obscura::crosscheck {
namespace {

using namespace test;
using testing::HasSubstr;

CheckedScene check(const Scene& scene, uint64_t rays) {
    Log log(Verbosity::quiet);
    const auto checked = check_scene({&scene, "test", "test.glb", few_rays(rays)}, log);
    if (!checked) throw std::runtime_error(checked.error().message);
    return *checked;
}

Scene shapes_and_cube() {
    Scene scene = closed_cube();
    add_shape(scene, make_shape(ShapeKind::sphere, 1.2F), 0);
    Affined place;
    place.m[0][0] = 2;
    place.m[1][1] = -0.5;
    place.m[0][3] = 3;
    add_shape(scene, make_shape(ShapeKind::frustum, 1, 0.7F, 0.3F), 0, place);
    return scene;
}

/// Long and thin enough that Embree rounds by a hundred times the usual.
TEST(CheckScene, ThinLinesAreWithinTheBudgetAndDoNotShadowThemselves) {
    Scene scene = empty_scene({});
    add_strip(scene, {{{-1, 0, 0}}, {{1, 0.2F, 0}}, {{0.5F, 1, 0.3F}}, {{-1, -1, 0.4F}}}, 0.0052F);
    const CheckedScene checked = check(scene, 65536);
    EXPECT_THAT(checked.faults, testing::IsEmpty());
    EXPECT_GT(checked.spawned.rays, 1000U);
    EXPECT_EQ(checked.spawned.self_hits, 0U);
}

/// A fence of lines whose segments are 400 times as long as thick: Embree's hits are off by up to a
/// hundredth of the radius, differently for each ray, and shading must start its rays further out
/// than that.
TEST(CheckSpawned, WhatShadingStartsOnThinLinesLeavesThem) {
    Scene scene = empty_scene({});
    constexpr int lines = 100;
    for (int i = 0; i < lines; ++i) {
        const float x = 0.015F * static_cast<float>(i);
        add_strip(scene, {{{x, -0.9F, 0.1F}}, {{x + 0.3F, 1, -0.2F}}}, 0.005F);
    }
    Log log(Verbosity::quiet);
    const auto prepared = PreparedScene::create(opaque_copy(scene), {}, Isa::automatic, log);
    ASSERT_TRUE(prepared.has_value());
    const TrueScene truth(prepared->scene());
    const RaySet rays(truth, few_rays(65536));
    const auto spawned = check_spawned(*prepared, truth, rays, Isa::automatic);
    ASSERT_TRUE(spawned.has_value());
    EXPECT_GT(spawned->rays, 30000U);
    EXPECT_EQ(spawned->self_hits, 0U);
    EXPECT_EQ(spawned->aimed_self_hits, 0U);
}

TEST(CheckScene, ACubeAndShapesAreWithinTheBudget) {
    const CheckedScene checked = check(shapes_and_cube(), 65536);
    EXPECT_THAT(checked.faults, testing::IsEmpty());
    EXPECT_EQ(checked.truth.wrong, 0U);
    EXPECT_GT(checked.truth.rays, 1000U);
    EXPECT_GE(checked.spawned.rays, 65536U);
    EXPECT_GT(checked.spawned.wall_rays, 60000U);
    size_t against_truth = 0;
    for (const PairFigures& pair : checked.pairs) {
        EXPECT_EQ(pair.total().rays, 65536U);
        against_truth += pair.against_truth ? 1 : 0;
    }
    EXPECT_GE(against_truth, 17U);
    for (const char* name : {"robust 16", "fast 1", "user triangles 16", "sphere points 1"})
        EXPECT_THAT(check_table(checked), HasSubstr(name));
}

TEST(CheckScene, IsTheSameForAnyNumberOfThreads) {
    const Scene scene = shapes_and_cube();
    std::string texts[2];
    for (int k = 0; k < 2; ++k) {
        const ThreadLimit limit(k + 1);
        texts[k] = crosscheck_json({check(scene, 16384)}, {});
    }
    EXPECT_EQ(texts[0], texts[1]);
}

TEST(CheckScene, AnEmptySceneHasNothingToDifferAbout) {
    const CheckedScene checked = check(empty_scene({}), 8192);
    EXPECT_TRUE(checked.faults.empty());
    EXPECT_EQ(checked.pairs.at(0).total().hits, 0U);
}

TEST(CheckScene, CutOutsDoNotCount) {
    Scene scene = square_scene();
    scene.materials[0].flags |= material_alpha_mask;
    scene.materials[0].alpha_cutoff = 2;  // nothing of it is there
    EXPECT_GT(check(scene, 8192).pairs.at(0).total().hits, 1000U);
}

TEST(CheckScene, ReplaysOneRay) {
    const auto text = replay_ray(square_scene(), {{0.5, -0.25, 3}, {0, 0, -2}}, Isa::automatic);
    ASSERT_TRUE(text.has_value());
    EXPECT_THAT(*text, HasSubstr("double precision"));
    EXPECT_THAT(*text, HasSubstr("t=1.5 instance=-1 primitive=0 row=0"));
    EXPECT_THAT(*text, testing::Not(HasSubstr("miss")));
}

TEST(CheckScene, TheImageShowsTheWorstVerdict) {
    ScreenVerdicts screen{2, 1, {static_cast<int8_t>(Verdict::false_hit), 0}, {1, 1}};
    const OutputImage image = screen_image(screen);
    EXPECT_EQ(image.pixels.at(0), 1.0F);
    EXPECT_EQ(image.pixels.at(1), 0.0F);
    EXPECT_EQ(image.pixels.at(3), image.pixels.at(4));
}

}  // namespace
}  // namespace obscura::crosscheck
