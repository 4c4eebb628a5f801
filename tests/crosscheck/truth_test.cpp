// tests/crosscheck/truth_test.cpp - the search in double against hand-computed hits.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/truth.h"

#include "crosscheck/check_scenes.h"
#include "crosscheck/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace obscura {
namespace {

using namespace test;

TEST(TrueScene, HitsATriangleWhereItIs) {
    const Scene scene = square_scene();
    const TrueScene truth(scene);
    const TrueHit hit = truth.nearest({{0.5, -0.25, 3}, {0, 0, -2}});
    EXPECT_DOUBLE_EQ(hit.t, 1.5);
    EXPECT_EQ(hit.item, (Item{-1, 0, 0}));
    EXPECT_FALSE(truth.nearest({{0.5, -0.25, 3}, {0, 0, 2}}).found());
    EXPECT_FALSE(truth.nearest({{1.5, 0, 3}, {0, 0, -1}}).found());
}

TEST(TrueScene, HitsBothSidesOfASphere) {
    Scene scene = empty_scene({});
    add_shape(scene, make_shape(ShapeKind::sphere, 2), 0);
    const TrueScene truth(scene);
    EXPECT_DOUBLE_EQ(truth.nearest({{0, 1, 5}, {0, 0, -1}}).t, 5 - std::sqrt(3.0));
    EXPECT_DOUBLE_EQ(truth.nearest({{0, 1, 0}, {0, 0, -1}}).t, std::sqrt(3.0));
    int count = 0;
    truth.all_hits({{0, 1, 5}, {0, 0, -1}}, [&](double, Item) { ++count; });
    EXPECT_EQ(count, 2);
}

TEST(TrueScene, SeesThroughAnInstanceAndItsMatrix) {
    Scene scene = empty_scene({});
    Affined place;
    place.m[0][0] = 3;
    place.m[2][2] = -1;
    place.m[1][3] = 10;
    add_shape(scene, make_shape(ShapeKind::box, 1, 1, 1), 0, place);
    const TrueScene truth(scene);
    const TrueHit hit = truth.nearest({{8, 10, 0}, {-1, 0, 0}});
    EXPECT_DOUBLE_EQ(hit.t, 5);
    EXPECT_EQ(hit.item, (Item{0, 0, 0}));
    const Vec3d normal = truth.normal(hit.item, {3, 10, 0});
    EXPECT_NEAR(normal.x, 1, 1e-12);
}

TEST(TrueScene, FindsPlanesWithoutEnd) {
    Scene scene = empty_scene({});
    add_shape(scene, make_shape(ShapeKind::plane, unbounded, unbounded), 0);
    const TrueScene truth(scene);
    const TrueHit hit = truth.nearest({{1e9, 4, 0}, {0, -0.5, 1}});
    EXPECT_DOUBLE_EQ(hit.t, 8);
    EXPECT_TRUE(truth.is_endless(hit.item));
}

TEST(TrueScene, TheTreeLeavesNothingOut) {
    SceneBuilder builder;
    builder.sphere({0.1F, 0.2F, 0.3F}, 1, 30, builder.material({}), true, true);
    const Scene scene = builder.take();
    const TrueScene truth(scene);
    for (uint64_t i = 0; i < 4000; ++i) {
        RandomStream random(i);
        const TrueRay ray{random.direction() * 2.0, random.direction()};
        EXPECT_EQ(truth.nearest(ray).t, truth.nearest_of_all(ray).t) << i;
    }
}

TEST(TrueScene, NumbersEveryInstancesItems) {
    Scene scene = empty_scene({});
    add_shape(scene, make_shape(ShapeKind::sphere, 1), 0);
    add_shape(scene, make_shape(ShapeKind::sphere, 1), 0, Affined{});
    const TrueScene truth(scene);
    ASSERT_EQ(truth.item_count(), 2U);
    EXPECT_EQ(truth.item(0), (Item{-1, 0, 0}));
    EXPECT_EQ(truth.item(1), (Item{0, 1, 0}));
}

}  // namespace
}  // namespace obscura
