// tests/crosscheck/side_test_test.cpp - the bound of rounding against sides in single precision.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/side_test.h"

#include "crosscheck/check_scenes.h"
#include "crosscheck/random.h"

#include <gtest/gtest.h>

namespace obscura::crosscheck {
namespace {

using namespace test;

/// Twice the side of an edge, every operation rounded to single precision. Not inlined: what is
/// rounded must not be fused.
[[gnu::noinline]] float rounded(float a, float b, char operation) {
    volatile float result = operation == '*' ? a * b : operation == '+' ? a + b : a - b;
    return result;
}

float twice_side(const Vec3f& from, const Vec3f& to, const Vec3f& d) {
    const auto sum = [](const Vec3f& a, const Vec3f& b, char op) {
        return Vec3f{rounded(a.x, b.x, op), rounded(a.y, b.y, op), rounded(a.z, b.z, op)};
    };
    const Vec3f e = sum(to, from, '-');
    const Vec3f m = sum(to, from, '+');
    const auto minor = [](float a, float b, float c, float f) {
        return rounded(rounded(a, b, '*'), rounded(c, f, '*'), '-');
    };
    const Vec3f c{minor(e.y, m.z, e.z, m.y), minor(e.z, m.x, e.x, m.z), minor(e.x, m.y, e.y, m.x)};
    const Vec3f p = sum(c, d, '*');
    return rounded(rounded(p.x, p.y, '+'), p.z, '+');
}

Vec3d as_single(const Vec3d& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

Vec3f single(const Vec3d& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

TEST(SideTest, NoRoundingIsMoreThanTheBoundAndSomeComesNear) {
    double nearest = 0;
    for (uint64_t i = 0; i < 200000; ++i) {
        RandomStream random(i);
        SideTest test{};
        test.direction = as_single(random.direction());
        // In the plane of the triangle, where nothing but rounding is left of all three sides.
        const Vec3d across = random.direction();
        for (Vec3d& corner : test.corner) {
            const Vec3d along = test.direction * random.between(0.5, 2);
            corner = as_single(along + across * random.between(-1, 1));
        }
        for (size_t k = 0; k < 3; ++k) {
            const auto got = static_cast<double>(
                twice_side(single(test.from(k)), single(test.to(k)), single(test.direction)));
            const double error = std::abs(0.5 * got + test.side(k));  // it is turned around
            nearest = std::max(nearest, error / test.rounding(k));
            EXPECT_LE(error, test.rounding(k)) << i;
        }
    }
    EXPECT_GT(nearest, 0.2);
}

TEST(SideTest, IsTheDistanceFromTheLineTimesTheEdge) {
    const Scene scene = square_scene();
    const TrueScene truth(scene);
    const Item item{-1, 0, 0};
    const TrueRay down{{0.25, -0.5, 4}, {0, 0, -1}};
    const SideTest test = side_test(truth, down, item, 0);
    double distances[3];
    for (size_t k = 0; k < 3; ++k)
        distances[k] = std::abs(test.side(k)) / length(test.to(k) - test.from(k));
    std::sort(distances, distances + 3);
    EXPECT_NEAR(distances[0], 0.5, 1e-12);                  // the lower edge
    EXPECT_NEAR(distances[1], 0.75 / std::sqrt(2), 1e-12);  // the diagonal
    EXPECT_NEAR(distances[2], 0.75, 1e-12);                 // the right edge
}

TEST(SideTest, AcrossAnEdgeTheBoundIsAFewUlp) {
    const Scene scene = square_scene();
    const TrueScene truth(scene);
    const Item item{-1, 0, 0};
    const TrueRay down{{0.25, -0.999, 4}, {0, 0, -1}};
    const double ulp = truth.rounding_m(down, item, 4);
    const SideTest test = side_test(truth, down, item, 0);
    for (size_t k = 0; k < 3; ++k) {
        const double edge = length(test.to(k) - test.from(k));
        EXPECT_LT(test.rounding(k) / edge, 4 * ulp);
    }
}

}  // namespace
}  // namespace obscura::crosscheck
