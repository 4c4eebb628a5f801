// tests/camera/aperture_test.cpp - points on the lens lie where they should, uniformly.
// SPDX-License-Identifier: Apache-2.0
#include "camera/aperture_table.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include <array>
#include <cmath>

namespace obscura::test {
namespace {

Aperture opening(float radius_m, int blades = 0) {
    Aperture out;
    out.radius_m = radius_m;
    out.blades = blades;
    return out;
}

std::vector<Vec2<double>> points_of(const Aperture& aperture, int count) {
    Pcg32 random(7);
    std::vector<Vec2<double>> points;
    for (int i = 0; i < count; ++i) {
        points.push_back(
            lens_point(aperture, Vec2<double>{random.next_float(), random.next_float()}));
    }
    return points;
}

double largest_radius_of(const std::vector<Vec2<double>>& points) {
    double largest = 0;
    for (const auto& p : points)
        largest = std::max(largest, std::hypot(p.x, p.y));
    return largest;
}

/// Uniform in area: a quarter of the points lie inside a circle of half the radius.
TEST(Aperture, ADiskIsFilledEvenly) {
    const Aperture aperture = opening(2);
    const auto points = points_of(aperture, 40000);
    EXPECT_NEAR(largest_radius_of(points), 2, 0.001);
    int inside = 0;
    int right = 0;
    for (const auto& p : points) {
        inside += std::hypot(p.x, p.y) < 1 ? 1 : 0;
        right += p.x > 0 ? 1 : 0;
    }
    EXPECT_NEAR(inside / 40000.0, 0.25, 0.01);
    EXPECT_NEAR(right / 40000.0, 0.5, 0.01);
}

TEST(Aperture, APolygonHasItsCornersOnTheCircleAndIsFilledEvenly) {
    for (const int blades : {3, 5, 6, 9}) {
        const Aperture aperture = opening(1, blades);
        const auto points = points_of(aperture, 60000);
        const double inner = std::cos(pi_d / blades);  // radius of the circle inside
        EXPECT_GT(largest_radius_of(points), inner + 0.5 * (1 - inner));
        int inside = 0;
        for (const auto& p : points) {
            // Inside of all edges: the normals point between two corners; one corner is at the top.
            for (int k = 0; k < blades; ++k) {
                const double angle = pi_d / 2 + (2 * k + 1) * pi_d / blades;
                EXPECT_LE(p.x * std::cos(angle) + p.y * std::sin(angle), inner + 1e-6);
            }
            inside += std::hypot(p.x, p.y) < inner / 2 ? 1 : 0;
        }
        const double area = 0.5 * blades * std::sin(2 * pi_d / blades);
        EXPECT_NEAR(inside / 60000.0, pi_d * inner * inner / 4 / area, 0.01);
    }
}

TEST(Aperture, RotationTurnsCounterClockwiseAndAnamorphicIsTaller) {
    const Aperture plain = opening(1, 3);
    Aperture turned = plain;
    turned.rotation_turns = 0.25f;
    const Vec2<double> u{0.9, 0.3};
    const Vec2<double> a = lens_point(plain, u);
    const Vec2<double> b = lens_point(turned, u);
    EXPECT_NEAR(b.x, -a.y, 1e-6);
    EXPECT_NEAR(b.y, a.x, 1e-6);
    Aperture tall = opening(1);
    tall.squeeze = 0.5f;
    double widest = 0;
    double highest = 0;
    for (const auto& p : points_of(tall, 20000)) {
        widest = std::max(widest, std::abs(p.x));
        highest = std::max(highest, std::abs(p.y));
    }
    EXPECT_NEAR(widest, 0.5, 0.01);
    EXPECT_NEAR(highest, 1, 0.01);
}

/// Two by two pixels: black, 1; 3, black.
TEST(Aperture, AnImageIsHitAsOftenAsItIsBright) {
    const ApertureTable table = make_aperture_table({0, 1, 3, 0}, 2, 2);
    Aperture aperture = opening(1);
    aperture.image = table.view();
    int lower_left = 0;
    constexpr int count = 40000;
    for (const auto& p : points_of(aperture, count)) {
        EXPECT_LE(std::max(std::abs(p.x), std::abs(p.y)), 1.0001);
        EXPECT_TRUE((p.x < 0) == (p.y < 0) || std::min(std::abs(p.x), std::abs(p.y)) < 1e-6)
            << p.x << " " << p.y;
        lower_left += p.x < 0 && p.y < 0 ? 1 : 0;
    }
    EXPECT_NEAR(lower_left / static_cast<double>(count), 0.75, 0.01);
    EXPECT_TRUE(make_aperture_table({0, 0, -1, 0}, 2, 2).rows.empty());
}

}  // namespace
}  // namespace obscura::test
