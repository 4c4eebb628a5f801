// tests/crosscheck/compare_test.cpp - every verdict about two answers, by hand.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/compare.h"

#include "crosscheck/check_scenes.h"
#include "crosscheck/place_check.h"

#include <gtest/gtest.h>

namespace obscura::crosscheck {
namespace {

using namespace test;

const Item lower{-1, 0, 0};  ///< with the corner (1, -1)
const Item upper{-1, 0, 1};

class CompareAnswers : public testing::Test {
protected:
    /// Down on the square from z = 4, where one ulp is that of 4.
    TrueRay down(double x, double y) const { return {{x, y, 4}, {0, 0, -1}}; }
    Verdict verdict(const TrueRay& ray, const Answer& got) const {
        return compare(truth_, ray, answer_of(truth_.nearest(ray)), got).verdict;
    }
    double ulp(const TrueRay& ray) const { return truth_.rounding_m(ray, lower, 4); }

    Scene scene_ = square_scene();
    TrueScene truth_{scene_};
};

TEST_F(CompareAnswers, AnUlpIsThatOfTheLargestNumberOnTheWay) {
    // Origin and distance add up to 8.
    EXPECT_DOUBLE_EQ(ulp(down(0, 0)), 8.0 / 8388608);
}

TEST_F(CompareAnswers, TheTruthAgreesWithItself) {
    const TrueRay ray = down(0.5, -0.5);
    EXPECT_EQ(truth_.nearest(ray).item, lower);
    EXPECT_EQ(verdict(ray, {4, lower}), Verdict::agree);
    EXPECT_EQ(verdict(down(3, 0), {}), Verdict::agree);
}

TEST_F(CompareAnswers, DepthAgreesWithinFourUlp) {
    const TrueRay ray = down(0.5, -0.5);
    EXPECT_EQ(verdict(ray, {4 + 3.9 * ulp(ray), lower}), Verdict::agree);
    // A ray that begins a few ulp later has it, too; one that begins twenty later does not.
    EXPECT_EQ(verdict(ray, {4 + 20 * ulp(ray), lower}), Verdict::depth);
    EXPECT_EQ(verdict(ray, {4 - 20 * ulp(ray), lower}), Verdict::depth);
}

TEST_F(CompareAnswers, ANeighbourAtTheCommonEdgeIsNoMismatch) {
    const double beside = 3 * ulp(down(0, 0));
    EXPECT_EQ(verdict(down(0.25 + beside, 0.25), {4, upper}), Verdict::equal_depth);
    EXPECT_EQ(verdict(down(0.25 - beside, 0.25), {4, lower}), Verdict::equal_depth);
}

TEST_F(CompareAnswers, ANeighbourIsNotThereFarFromTheEdge) {
    EXPECT_EQ(verdict(down(0.5, -0.5), {4, upper}), Verdict::item);
    EXPECT_EQ(verdict(down(-0.5, 0.5), {4, lower}), Verdict::item);
    EXPECT_EQ(verdict(down(0.25 + 40 * ulp(down(0, 0)), 0.25), {4, upper}), Verdict::item);
}

TEST_F(CompareAnswers, WhatDoesNotExistIsNotThere) {
    for (const Item& item : {Item{-1, 0, 2}, Item{-1, 1, 0}, Item{0, 0, 0}, Item{-2, 0, 0}}) {
        EXPECT_FALSE(truth_.has(item));
        EXPECT_EQ(verdict(down(0.5, -0.5), {4, item}), Verdict::item);
        EXPECT_EQ(verdict(down(5, 0), {4, item}), Verdict::item);
    }
    EXPECT_TRUE(truth_.has(lower) && truth_.has(upper));
}

TEST(CompareCoplanar, SurfacesInOnePlaceAreEachThere) {
    SceneBuilder builder;
    const int32_t material = builder.material({});
    builder.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, material);
    builder.quad({-1, -1, 0}, {1, 0, 0}, {0, 2, 0}, material);  // its left half again
    const Scene scene = builder.take();
    const TrueScene truth(scene);
    const auto verdict = [&](double x, const Item& item) {
        const TrueRay ray{{x, -0.75, 4}, {0, 0, -1}};
        return compare(truth, ray, answer_of(truth.nearest(ray)), {4, item}).verdict;
    };
    const Item whole{-1, 0, 0};
    const Item half{-1, 1, 0};
    ASSERT_TRUE(truth.has(half));
    EXPECT_LE(verdict(-0.5, whole), Verdict::equal_depth);
    EXPECT_LE(verdict(-0.5, half), Verdict::equal_depth);
    EXPECT_EQ(verdict(0.5, whole), Verdict::agree);
    EXPECT_EQ(verdict(0.5, half), Verdict::item);
}

/// The weights of the corners, and the cross product of two edges.
TEST(CheckPlace, OfATriangleInAnInstance) {
    Scene scene = square_scene();
    Affined place;
    place.m[0][0] = 2;
    place.m[1][2] = 1;
    place.m[2][1] = -3;
    place.m[1][1] = place.m[2][2] = 0;
    scene.meshes.push_back({0, scene.world_primitive_count});
    scene.world_primitive_count = 0;
    Instance instance;
    instance.world_from_object = affine_cast<float>(place);
    scene.instances.push_back(instance);
    const TrueScene truth(scene);
    const Item item = truth.item(0);
    const Triangle<double> t = truth.triangle(item);
    const Vec3d hit = t.a * 0.5 + t.b * 0.3 + t.c * 0.2;
    const TrueRay ray{hit + Vec3d{0.4, 3, 0.2}, {-0.4, -3, -0.2}};
    ASSERT_NEAR(truth.nearest(ray).t, 1, 1e-9);
    const auto is_right = [&](double u, double v, const Vec3d& ng) {
        Answer answer{1, item};
        answer.place = {u, v, ng, true, true};
        return is_right_place(truth, ray, answer);
    };
    EXPECT_TRUE(is_right(0.3, 0.2, {0, 0, 4}));
    EXPECT_TRUE(is_right(0.3 + 1e-8, 0.2, {0, 1e-8, 4}));
    EXPECT_FALSE(is_right(0.3 + 1e-4, 0.2, {0, 0, 4}));
    EXPECT_FALSE(is_right(0.2, 0.3, {0, 0, 4}));
    EXPECT_FALSE(is_right(0.3, 0.2, {0, 0, -4}));
    EXPECT_FALSE(is_right(0.3, 0.2, {0, 0.001, 4}));
}

TEST_F(CompareAnswers, AtTheOuterEdgeHitAndMissAreBothRight) {
    const TrueRay inside = down(1 - 3 * ulp(down(0, 0)), 0.25);
    EXPECT_EQ(verdict(inside, {}), Verdict::edge);
    const TrueRay outside = down(1 + 3 * ulp(down(0, 0)), 0.25);
    EXPECT_EQ(verdict(outside, {4, lower}), Verdict::edge);
}

TEST_F(CompareAnswers, FurtherFromTheEdgeOnlyOneIs) {
    const TrueRay inside = down(1 - 12 * ulp(down(0, 0)), 0.25);
    EXPECT_EQ(verdict(inside, {}), Verdict::missed);
    const TrueRay outside = down(1 + 40 * ulp(down(0, 0)), 0.25);
    EXPECT_EQ(verdict(outside, {4, lower}), Verdict::false_hit);
}

TEST_F(CompareAnswers, AMissAtACommonEdgeIsACrack) {
    const TrueRay ray = down(0.25, 0.25 + ulp(down(0, 0)));
    EXPECT_EQ(verdict(ray, {}), Verdict::crack);
    EXPECT_EQ(verdict(down(0.25, 0.3), {}), Verdict::missed);
}

TEST_F(CompareAnswers, OcclusionKnowsNoDepth) {
    const TrueRay ray = down(0.5, -0.5);
    Answer any;
    any.any = true;
    EXPECT_EQ(verdict(ray, any), Verdict::agree);
    EXPECT_EQ(verdict(down(3, 0), any), Verdict::false_hit);
}

TEST_F(CompareAnswers, OcclusionOfARayAlongATriangleIsChance) {
    Answer any;
    any.any = true;
    const double height = ulp(down(0, 0)) / 4;
    const TrueRay along{{-3, 0.2, height}, {1, 0.05, 0}};
    EXPECT_FALSE(truth_.nearest(along).found());
    EXPECT_EQ(verdict(along, any), Verdict::crack);
    EXPECT_EQ(verdict({{-3, 0.2, 100 * height}, {1, 0.05, 0}}, any), Verdict::false_hit);
}

TEST_F(CompareAnswers, InATrianglesPlaneNothingTiesAHitToTheTriangle) {
    const double height = ulp(down(0, 0)) / 4;
    const auto beside = [&](double z) { return TrueRay{{-3, 5, z}, {1, 0.05, 0}}; };
    EXPECT_EQ(verdict(beside(height), {3, lower}), Verdict::edge_on);
    EXPECT_EQ(verdict(beside(400 * height), {3, lower}), Verdict::false_hit);
    Answer any;  // of that triangle or the other one
    any.any = true;
    EXPECT_EQ(verdict(beside(height), any), Verdict::edge_on);
    EXPECT_EQ(verdict(beside(400 * height), any), Verdict::false_hit);
    // Across the plane the third side decides: it has passed the corner by a fifth of the edge.
    const TrueRay across{{1.4, -1, 4}, {0, 0, -1}};
    EXPECT_EQ(verdict(across, {4, lower}), Verdict::false_hit);
}

TEST(CompareOcclusion, ARingSeenEdgeOnIsNotOnlyItsHole) {
    Scene scene = empty_scene({});
    ShapeRecord ring = make_shape(ShapeKind::disk, 0.45F, 0.18F);
    add_shape(scene, ring, 0);
    const TrueScene truth(scene);
    const Item item = truth.item(0);
    Answer any;
    any.any = true;
    for (const double ulps : {1.3, 3.1}) {
        TrueRay along{{-4.3, 0, 0.05}, {1, 0, 0}};
        along.origin.y = ulps * truth.rounding_m(along, item, 4.3);
        ASSERT_FALSE(truth.nearest(along).found());
        EXPECT_EQ(compare(truth, along, {}, any).verdict, Verdict::crack);
        along.origin.y *= 20;
        EXPECT_EQ(compare(truth, along, {}, any).verdict, Verdict::false_hit);
    }
}

TEST_F(CompareAnswers, EdgeDistanceOfAMismatchIsReported) {
    const TrueRay inside = down(1 - 12 * ulp(down(0, 0)), 0.25);
    const Comparison found = compare(truth_, inside, answer_of(truth_.nearest(inside)), {});
    EXPECT_GE(found.ulps, 12);
    EXPECT_LE(found.ulps, 32);
}

}  // namespace
}  // namespace obscura::crosscheck
