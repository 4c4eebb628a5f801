// tests/shape/lecture_test.cpp - the lecture's formulas, written out, against those that render.
// SPDX-License-Identifier: Apache-2.0
#include "shape/shape_truth.h"
#include "shape/triangle.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

using namespace test;

Vec3d random_vector(Pcg32& random) {
    const double x = 2 * random.next_double() - 1;
    const double y = 2 * random.next_double() - 1;
    return {x, y, 2 * random.next_double() - 1};
}

TEST(Lecture, PlaneByItsFormula) {
    Pcg32 random(21);
    for (int i = 0; i < 2000; ++i) {
        const Plane<double> plane{random_vector(random), 1e300, 1e300};
        const ShapeRay<double> ray{random_vector(random) * 3.0, random_vector(random)};
        const Vec3d n{0, 1, 0};
        const double t = dot(plane.centre - ray.origin, n) / dot(ray.direction, n);
        if (std::abs(ray.direction.y) < 1e-3) continue;
        const Roots<double> roots = intersect_plane(plane, ray);
        ASSERT_TRUE(roots.hit[0]);
        ASSERT_NEAR(roots.t[0], t, 1e-9 * (1 + std::abs(t)));
    }
    const Plane<double> floor{{0, 0, 0}, 1e300, 1e300};
    EXPECT_FALSE(intersect_plane<double>(floor, {{0, 1, 0}, {1, 0, 0}}).hit[0]);
}

TEST(Lecture, TheDiscriminantHasThreeCases) {
    Pcg32 random(22);
    int cases[2] = {0, 0};
    for (int i = 0; i < 2000; ++i) {
        const Sphere<double> sphere{random_vector(random), 0.2 + random.next_double()};
        const Vec3d origin = random_vector(random) * 4.0;
        const ShapeRay<double> ray{origin, random_vector(random) * 2.0 - origin};
        const Vec3d from = ray.origin - sphere.centre;
        const double a = dot(ray.direction, ray.direction);
        const double b = dot(ray.direction, from);
        const double c = dot(from, from) - sphere.radius * sphere.radius;
        const double discriminant = b * b - a * c;
        if (std::abs(discriminant) < 1e-9) continue;
        const Roots<double> roots = intersect_sphere(sphere, ray);
        ++cases[discriminant > 0 ? 1 : 0];
        ASSERT_EQ(roots.hit[0], discriminant > 0);
        ASSERT_EQ(roots.hit[1], discriminant > 0);
        if (discriminant < 0) continue;
        const double root = std::sqrt(discriminant);
        ASSERT_NEAR(roots.t[0], (-b - root) / a, 1e-9 * (1 + std::abs(roots.t[0])));
        ASSERT_NEAR(roots.t[1], (-b + root) / a, 1e-9 * (1 + std::abs(roots.t[1])));
    }
    EXPECT_GT(cases[0], 200);
    EXPECT_GT(cases[1], 200);
    // D = 0: both roots are one. Exact numbers, so that it is exactly 0.
    const Sphere<double> sphere{{0, 0, -5}, 2};
    const Roots<double> touched = intersect_sphere<double>(sphere, {{2, 0, 0}, {0, 0, -1}});
    EXPECT_TRUE(touched.hit[0]);
    EXPECT_EQ(touched.t[0], 5);
    EXPECT_EQ(touched.t[1], 5);
}

double determinant_of(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    return dot(a, cross(b, c));
}

TEST(Lecture, TriangleSolvesTheSystemOfThreeEquations) {
    Pcg32 random(23);
    int hits = 0;
    for (int i = 0; i < 5000; ++i) {
        const Triangle<double> t{
            random_vector(random), random_vector(random), random_vector(random)};
        const Vec3d origin = random_vector(random) * 3.0;
        const ShapeRay<double> ray{origin, random_vector(random) - origin};
        const Vec3d first = t.a - t.b;  // the columns of the system, and its right side
        const Vec3d second = t.a - t.c;
        const Vec3d right = t.a - ray.origin;
        const double whole = determinant_of(first, second, ray.direction);
        if (std::abs(whole) < 1e-3) continue;
        const double beta = determinant_of(right, second, ray.direction) / whole;
        const double gamma = determinant_of(first, right, ray.direction) / whole;
        const double distance = determinant_of(first, second, right) / whole;
        const TriangleHit<double> hit = intersect_triangle(t, ray);
        const double edge = std::min({std::abs(beta), std::abs(gamma), std::abs(1 - beta - gamma)});
        if (edge < 1e-9) continue;
        ASSERT_EQ(hit.hit, beta > 0 && gamma > 0 && beta + gamma < 1);
        hits += hit.hit ? 1 : 0;
        ASSERT_NEAR(hit.beta, beta, 1e-8 * (1 + std::abs(beta)));
        ASSERT_NEAR(hit.gamma, gamma, 1e-8 * (1 + std::abs(gamma)));
        ASSERT_NEAR(hit.t, distance, 1e-8 * (1 + std::abs(distance)));
    }
    EXPECT_GT(hits, 100);
}

TEST(Lecture, QuadricIsAQuadraticEquation) {
    // x^T Q x with x = o + t d is a t^2 + b t + c: c is the value at o, a + b + c the one at o + d.
    Pcg32 random(24);
    int hits = 0;
    for (int i = 0; i < 3000; ++i) {
        Quadric<double> q{{0, 0, 0}, {50, 50, 50}, {}};
        for (double& k : q.k)
            k = 2 * random.next_double() - 1;
        const ShapeRay<double> ray{random_vector(random), random_vector(random)};
        const auto value = [&](double t) {
            const Vec3d p = ray.origin + ray.direction * t;
            return q.k[0] * p.x * p.x + q.k[1] * p.y * p.y + q.k[2] * p.z * p.z +
                   q.k[3] * p.x * p.y + q.k[4] * p.x * p.z + q.k[5] * p.y * p.z + q.k[6] * p.x +
                   q.k[7] * p.y + q.k[8] * p.z + q.k[9];
        };
        const double c = value(0);
        const double a = 0.5 * (value(1) + value(-1)) - c;
        const double b = value(1) - a - c;
        const double discriminant = b * b - 4 * a * c;
        if (std::abs(a) < 0.05 || std::abs(discriminant) < 1e-3) continue;
        const Roots<double> roots = intersect_quadric(q, ray);
        ASSERT_EQ(roots.hit[0], discriminant > 0);
        if (discriminant < 0) continue;
        ++hits;
        const double root = std::sqrt(discriminant);
        const double low = std::min((-b - root) / (2 * a), (-b + root) / (2 * a));
        const double high = std::max((-b - root) / (2 * a), (-b + root) / (2 * a));
        ASSERT_NEAR(roots.t[0], low, 1e-8 * (1 + std::abs(low)));
        ASSERT_NEAR(roots.t[1], high, 1e-8 * (1 + std::abs(high)));
    }
    EXPECT_GT(hits, 500);
}

}  // namespace
}  // namespace obscura
