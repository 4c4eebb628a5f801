// tests/crosscheck/truth_test.cpp - the search in double against hand-computed hits.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/truth.h"

#include "accel/accel.h"
#include "crosscheck/check_scenes.h"
#include "crosscheck/random.h"
#include "crosscheck/ray_set.h"
#include "crosscheck/shape_side.h"

#include <gtest/gtest.h>

#include "support/points_lines_scenes.h"
#include <cmath>

namespace obscura::crosscheck {
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
    EXPECT_NEAR(truth.nearest({{0, 1, 5}, {0, 0, -1}}).t, 5 - std::sqrt(3.0), 1e-13);
    EXPECT_NEAR(truth.nearest({{0, 1, 0}, {0, 0, -1}}).t, std::sqrt(3.0), 1e-13);
    int count = 0;
    truth.all_hits({{0, 1, 5}, {0, 0, -1}}, [&](double, Item) { ++count; });
    EXPECT_EQ(count, 2);
}

TEST(TrueScene, DistanceFromASegmentIsThatFromTheNearestOfItsSpheres) {
    ShapeRecord record = make_shape(ShapeKind::capsule, 1.5F, 0.75F, 0.25F);
    const SegmentFrame<double> frame = frame_of<double>({{1, 1, 1}, {1, 1, 4}, 0.75, 0.25});
    for (uint64_t i = 0; i < 1000; ++i) {
        RandomStream random(i);
        const Vec3d place{random.between(-2, 2), random.between(-3, 3), random.between(-2, 2)};
        const Vec3d world = frame.centre + out_of_frame(frame, place);
        EXPECT_NEAR(side_of_hull({{1, 1, 1}, {1, 1, 4}}, {0.75, 0.25}, world),
                    side_of_shape(record, place),
                    1e-9);
    }
}

/// A right angle of two segments of radius 0.1: one solid, as in Embree.
TEST(TrueScene, ALineHasNoBoundaryWhereItsSegmentsMeet) {
    Scene scene = empty_scene({});
    add_strip(scene, {{{-1, 0, 0}}, {{0, 0, 0}}, {{0, 1, 0}}}, 0.1F);
    add_strip(scene, {{{5, 0, 0}}, {{6, 0, 0}}}, 0.1F);
    add_strip(scene, {{{6, 0, 0}}, {{6, 1, 0}}}, 0.1F);  // begins there, but is another line
    const TrueScene truth(scene);
    EXPECT_NEAR(truth.nearest({{-0.5, 0, 0}, {1, 0, 0}}).t, 0.6, 1e-7);
    EXPECT_NEAR(truth.nearest({{0, 0.5, 0}, {0, -1, 0}}).t, 0.6, 1e-7);
    // Through the corner from one segment to the other: there is only the exit.
    const TrueRay round_corner{{-0.05, 0.02, 0}, normalize(Vec3d{0.1, 0.5, 0})};
    EXPECT_EQ(truth.nearest(round_corner).item, (Item{-1, 0, 1}));
    EXPECT_NEAR(truth.nearest({{5.5, 0, 0}, {1, 0, 0}}).t, 0.4, 1e-7);
    EXPECT_EQ(truth.nearest({{5.95, 0.05, 0}, {0, 1, 0}}).item, (Item{-1, 1, 0}));
}

/// The sums of docs/crosscheck.md for a segment of length 1 and radius 0.05, seen from across.
TEST(TrueScene, AnUlpOfALineIsAQuarterOfWhatItsTestMayBeOff) {
    Scene scene = empty_scene({});
    add_strip(scene, {{{0, 0, 0}}, {{0, 1, 0}}}, 0.05F);
    const TrueScene truth(scene);
    const auto rounding = [&](double y) {
        return truth.rounding_m({{0, y, 2}, {0, 0, -1}}, {-1, 0, 0}, 1.95);
    };
    constexpr double half_ulp = 0.5 / 8388608;
    const auto expected = [](double o_o, double o_p) {
        const double a = 9 * 0.05 * 0.05;
        const double c = 11 * (o_o + o_p * o_p + 0.05 * 0.05);
        const double solving = 32 * 0.05 * 0.05;
        return 0.25 * half_ulp * (a + c + solving) / (2 * 0.05);
    };
    EXPECT_NEAR(rounding(0.5), expected(0.25, 0.5), 1e-5 * half_ulp);
    EXPECT_NEAR(rounding(1), expected(1, 1), 1e-5 * half_ulp);
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
    EXPECT_TRUE(truth.is_infinite(hit.item));
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

TEST(TrueScene, LinesAreCapsules) {
    Scene scene = empty_scene({});
    add_strip(scene, {{{-2, 0, 0}}, {{2, 0, 0}}, {{2, 3, 0}}}, 0.5F);
    const TrueScene truth(scene);
    const TrueHit side = truth.nearest({{1, 0.25, 5}, {0, 0, -1}});
    EXPECT_NEAR(side.t, 5 - std::sqrt(0.25 - 0.0625), 1e-12);
    EXPECT_EQ(side.item, (Item{-1, 0, 0}));
    const Vec3d normal = truth.normal(side.item, {1, 0.25, 5 - side.t});
    EXPECT_NEAR(normal.y, 0.5, 1e-10);  // by differences
    EXPECT_NEAR(truth.nearest({{-9, 0, 0}, {1, 0, 0}}).t, 6.5, 1e-12);
    EXPECT_EQ(truth.nearest({{2, 9, 0}, {0, -1, 0}}).item, (Item{-1, 0, 1}));
    EXPECT_NEAR(length(truth.middle({-1, 0, 1}) - Vec3d{2, 1.5, 0}), 0, 1e-12);
    EXPECT_FALSE(truth.nearest({{1, 0.51, 5}, {0, 0, -1}}).found());
}

/// A bent tube of changing thickness, met by Embree's capsules and by ours.
TEST(TrueScene, EmbreesLinesLieWhereOursDo) {
    Scene scene = empty_scene({});
    std::vector<Dot> dots;
    for (int i = 0; i < 30; ++i) {
        const float angle = 0.4F * static_cast<float>(i);
        dots.push_back({{std::cos(angle), 0.1F * static_cast<float>(i) - 1.5F, std::sin(angle)}});
    }
    add_strip(scene, dots, 1);
    for (size_t i = 0; i < 30; ++i)
        scene.curve_points[4 * i + 3] = 0.05F + 0.002F * static_cast<float>(i);
    const TrueScene truth(scene);
    const Result<Accel> accel = Accel::build(scene, "");
    ASSERT_TRUE(accel);
    RayBlock rays;
    for (uint64_t i = 0; i < 4000; ++i) {
        RandomStream random(i);
        const Vec3d from = random.direction() * 4.0;
        const Vec3d way = normalize(random.direction() * 1.2 - from);
        rays.add(from, way);
    }
    HitBlock hits;
    const RayColumns columns = rays.columns();
    accel->intersect(columns, hits.columns(columns.count), Coherence::incoherent, {});
    int both = 0;
    int apart = 0;
    for (int i = 0; i < columns.count; ++i) {
        const TrueHit hit = truth.nearest(rays.true_ray(i));
        const bool found = hits.item(i).primitive >= 0;
        apart += found != hit.found() ? 1 : 0;
        if (!found || !hit.found()) continue;
        ++both;
        EXPECT_NEAR(hits.t(i), hit.t, 2e-4) << i;
    }
    EXPECT_GT(both, 300);
    EXPECT_LE(apart, 2) << "at the silhouette rounding decides";
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
}  // namespace obscura::crosscheck
