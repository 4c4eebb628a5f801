// tests/crosscheck/crossings_test.cpp - lines and shapes whose crossings are known.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/crossings.h"

#include "crosscheck/random.h"
#include "crosscheck/shape_side.h"

#include <gtest/gtest.h>

#include "support/shape_scenes.h"

namespace obscura::crosscheck {
namespace {

using namespace test;

ShapeRecord quadric(const float (&k)[10]) {
    ShapeRecord record = make_shape(ShapeKind::quadric, 0.5F, 0.5F, 0.5F);
    std::copy(std::begin(k), std::end(k), std::begin(record.k));
    return record;
}

void expect_crossings(const Crossings& found, const std::vector<double>& expected) {
    ASSERT_EQ(found.count, static_cast<int>(expected.size()));
    for (size_t k = 0; k < expected.size(); ++k)
        EXPECT_NEAR(found.t[k], expected[k], 1e-7 * (1 + std::abs(expected[k])));
}

TEST(Crossings, OfSolidsAlongTheirAxes) {
    const TrueRay down{{0, 5, 0}, {0, -2, 0}};
    expect_crossings(cross_shape(make_shape(ShapeKind::sphere, 1), down), {2, 3});
    expect_crossings(cross_shape(make_shape(ShapeKind::box, 1, 2, 3), down), {1.5, 3.5});
    expect_crossings(cross_shape(make_shape(ShapeKind::frustum, 1, 2, 0), down), {2, 3});
    expect_crossings(cross_shape(make_shape(ShapeKind::capsule, 1, 2, 0.5F), down), {1.75, 4});
    expect_crossings(cross_shape(make_shape(ShapeKind::plane, 1, 1), down), {2.5});
    expect_crossings(cross_shape(make_shape(ShapeKind::disk, 1, 0.5F), down), {});
    expect_crossings(cross_shape(make_shape(ShapeKind::frustum, 1, 2, 2), {{1.9, 0, 0}, {0, 1, 0}}),
                     {-1, 1});
}

TEST(Crossings, ATouchIsTwoInOnePlace) {
    const ShapeRecord sphere = make_shape(ShapeKind::sphere, 2);
    expect_crossings(cross_shape(sphere, {{2, 0, 5}, {0, 0, -1}}), {5, 5});
    expect_crossings(cross_shape(sphere, {{2 + 1e-12, 0, 5}, {0, 0, -1}}), {});
    const ShapeRecord cylinder = make_shape(ShapeKind::frustum, 1, 0.5F, 0.5F);
    expect_crossings(cross_shape(cylinder, {{0.5, 0.25, 5}, {0, 0, -1}}), {5, 5});
    expect_crossings(cross_shape(cylinder, {{0.75, 0, 0}, {0, 1, 0}}), {});
}

TEST(Crossings, OfQuadricsAlongRulingsThereAreNone) {
    const ShapeRecord pipe = quadric({1, 1, 0, 0, 0, 0, 0, 0, 0, -0.09F});
    expect_crossings(cross_shape(pipe, {{0.1, 0.2, 3}, {0, 0, -1}}), {});
    expect_crossings(cross_shape(pipe, {{0.5, 0.2, 3}, {0, 0, -1}}), {});
    const double half = std::sqrt(static_cast<double>(0.09F));
    expect_crossings(cross_shape(pipe, {{-3, 0, 0.2}, {1, 0, 0}}), {3 - half, 3 + half});
    const ShapeRecord plane = quadric({0, 0, 0, 0, 0, 0, 0.5F, -0.5F, 0, 0.125F});
    expect_crossings(cross_shape(plane, {{0.25, 0, 0}, {1, 1, 0}}), {});
    expect_crossings(cross_shape(plane, {{0, -3, 0}, {0, 1, 0}}), {3.25});
    // In the surface: the saddle y = x^2 - z^2 holds the line x = z, y = 0.
    const ShapeRecord saddle = quadric({1, 0, -1, 0, 0, 0, 0, -1, 0, 0});
    expect_crossings(cross_shape(saddle, {{0, 0, 0}, {1, 0, 1}}), {});
}

TEST(Crossings, OfAPlaneSquaredAndOfAConesPoint) {
    const ShapeRecord squared = quadric({1, 1, 0, 2, 0, 0, 0, 0, 0, 0});
    for (uint64_t i = 0; i < 2000; ++i) {
        RandomStream random(i);
        const double x = random.between(-0.4, 0.4);
        const Vec3d place{x, -x, random.between(-0.4, 0.4)};
        const Vec3d way = random.direction();
        if (std::abs(way.x + way.y) < 0.01) continue;
        expect_crossings(cross_shape(squared, {place - way * 3.0, way}), {3, 3});
    }
    // (z + 0.05)^2 in single precision is no square, or two planes.
    const ShapeRecord beside = quadric({0, 0, 1, 0, 0, 0, 0, 0, 0.1F, 0.0025F});
    const double level = static_cast<double>(0.05F);
    expect_crossings(cross_shape(beside, {{0.1, 0.2, 3}, {0, 0, -1}}), {3 + level, 3 + level});
    const ShapeRecord cone = quadric({1, -1, 1, 0, 0, 0, 0, 0, 0, 0});
    expect_crossings(cross_shape(cone, {{3, 0, 0}, {-1, 0, 0}}), {3, 3});
    expect_crossings(cross_shape(cone, {{0, 3, 0}, {0, -1, 0}}), {3, 3});
}

TEST(Crossings, OfTheHullOfTwoSpheres) {
    const Vec3d middle[2] = {{0, 0, 0}, {0, 0, 4}};
    expect_crossings(cross_hull(middle, {1, 1}, {{5, 0, 2}, {-1, 0, 0}}), {4, 6});
    expect_crossings(cross_hull(middle, {1, 2}, {{0, 0, 9}, {0, 0, -1}}), {3, 10});
    // One sphere holds the other.
    expect_crossings(cross_hull({{0, 0, 0}, {0, 0, 1}}, {3, 1}, {{0, 9, 0}, {0, -1, 0}}), {6, 12});
}

/// Every line through a common edge meets one of two triangles, or both.
TEST(Crossings, NoLineGoesBetweenNeighbours) {
    for (uint64_t i = 0; i < 20000; ++i) {
        RandomStream random(i);
        const Vec3d a = random.direction();
        const Vec3d b = random.direction();
        const Vec3d c = random.direction() * 2.0;
        const Vec3d d = a + b - c;
        const Vec3d place = a + (b - a) * random.between(0.01, 0.99);
        const Vec3d way = random.direction();
        const TrueRay line{place - way * 10.0, way};
        const int left = cross_triangle({a, b, c}, line).count;
        const int right = cross_triangle({b, a, d}, line).count;
        EXPECT_GE(left + right, 1) << i;
    }
    expect_crossings(cross_triangle({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0.2, 0.2, 3}, {0, 0, -2}}),
                     {1.5});
    expect_crossings(cross_triangle({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{-1, 0.2, 0}, {1, 0, 0}}),
                     {});
    expect_crossings(cross_triangle({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{1, 1, 3}, {0, 0, -1}}),
                     {});
}

}  // namespace
}  // namespace obscura::crosscheck
