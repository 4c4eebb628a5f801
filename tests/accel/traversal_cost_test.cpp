// tests/accel/traversal_cost_test.cpp - the number of tests per ray, counted by hand.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/shape_scenes.h"

namespace obscura::test {
namespace {

constexpr int sheets = 12;

/// Triangles one behind the other at z = 0, -1, ...: each fills the lower left half of its box.
SceneBuilder stack(const Material& m) {
    SceneBuilder builder;
    const int32_t index = builder.material(m);
    for (int i = 0; i < sheets; ++i) {
        builder.quad({0, 0, static_cast<float>(-i)}, {1, 0, 0.1f}, {0, 1, 0.1f}, index);
        Scene& scene = builder.scene();
        --scene.primitives.back().triangle_count;
        scene.indices.resize(scene.indices.size() - 3);
        std::copy_n(scene.positions.end() - 3, 3, scene.positions.end() - 6);  // the third corner
    }
    return builder;
}

float tests_of(const Scene& scene, const Vec3f& origin, const Vec3f& direction) {
    const Result<Accel> accel = Accel::build_counting(scene, "");
    float column[6][16] = {{origin.x}, {origin.y}, {origin.z}, {}, {}, {}};
    column[3][0] = direction.x;
    column[4][0] = direction.y;
    column[5][0] = direction.z;
    float tests[16] = {};
    const RayColumns rays{
        column[0], column[1], column[2], column[3], column[4], column[5], nullptr, nullptr, 1};
    EXPECT_EQ(accel->count_tests(rays, tests), 0);
    return tests[0];
}

Material double_sided() {
    Material m;
    m.flags = material_double_sided;
    return m;
}

TEST(TraversalCost, TheNearestHitEndsTheSearch) {
    const Scene scene = stack(double_sided()).take();
    EXPECT_EQ(tests_of(scene, {0.25f, 0.25f, 5}, {0, 0, -1}), 1);
    EXPECT_EQ(tests_of(scene, {0.25f, 0.25f, -50}, {0, 0, 1}), 1);
}

TEST(TraversalCost, WhatIsMetInItsBoxAloneIsTestedInVain) {
    const Scene scene = stack(double_sided()).take();
    EXPECT_EQ(tests_of(scene, {0.9f, 0.9f, 5}, {0, 0, -1}), sheets);
    EXPECT_EQ(tests_of(scene, {1.5f, 0.9f, 5}, {0, 0, -1}), 0);
    EXPECT_EQ(tests_of(scene, {0.9f, 0.9f, -3.5f}, {0, 0, -1}), sheets - 4);
}

TEST(TraversalCost, HiddenBacksAndHolesLetTheRayGoOn) {
    const Scene single = stack({}).take();
    EXPECT_EQ(tests_of(single, {0.25f, 0.25f, 5}, {0, 0, -1}), 1);
    EXPECT_EQ(tests_of(single, {0.25f, 0.25f, -50}, {0, 0, 1}), sheets);
    Material clear = double_sided();
    clear.flags |= material_alpha_mask;
    clear.base_color[3] = 0.1f;
    clear.alpha_cutoff = 0.5f;
    EXPECT_EQ(tests_of(stack(clear).take(), {0.25f, 0.25f, 5}, {0, 0, -1}), sheets);
}

TEST(TraversalCost, ShapesAndPlanesWithoutEndCount) {
    Scene scene = stack(double_sided()).take();
    add_shape(scene, make_shape(ShapeKind::sphere, 0.5f), 0);
    add_shape(scene, make_shape(ShapeKind::plane, unbounded, unbounded), 0);
    EXPECT_EQ(tests_of(scene, {-0.49f, 0.49f, 5}, {0, 0, -1}), 2) << "the ball's box, the plane";
    EXPECT_EQ(tests_of(scene, {-0.25f, 0.25f, 5}, {0, 0, -1}), 2);
    EXPECT_EQ(tests_of(scene, {3, 3, 5}, {0, 0, -1}), 1) << "the plane alone";
}

TEST(TraversalCost, RaysThatAreNotFiniteCostNothing) {
    const Scene scene = stack(double_sided()).take();
    const Result<Accel> accel = Accel::build_counting(scene, "");
    const float nan[16] = {NAN};
    float tests[16] = {7};
    EXPECT_EQ(accel->count_tests({nan, nan, nan, nan, nan, nan, nullptr, nullptr, 1}, tests), 1);
    EXPECT_EQ(tests[0], 0);
}

}  // namespace
}  // namespace obscura::test
