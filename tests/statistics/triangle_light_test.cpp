// tests/statistics/triangle_light_test.cpp - chi-square of points and directions of a light.
// SPDX-License-Identifier: Apache-2.0
#include "light/triangle_light.h"

#include <gtest/gtest.h>

#include "support/chi_square.h"

namespace obscura {
namespace {

constexpr int test_count = 4;  ///< right densities below

const Vec3f corners[3] = {{-3, 1, -1}, {2, 0.5F, -2}, {0.5F, 2, 3}};

TriangleLight test_light() {
    TriangleLight light = make_triangle_light(corners[0], corners[1], corners[2]);
    light.pdf_area = 1 / light.area;
    light.two_sided = 1;
    return light;
}

template <typename F>
Vec2<F> random_square(Pcg32& random) {
    const auto x = static_cast<F>(random.next_float());
    return {x, static_cast<F>(random.next_float())};
}

TEST(TriangleLightStatistics, PointsAreUniformInArea) {
    const auto sample = [](Pcg32& random) -> std::optional<Vec2<double>> {
        return triangle_from_square(random_square<double>(random));
    };
    const auto uniform = [](double x, double y) { return x + y < 1 ? 2.0 : 0.0; };
    const ChiSquareOutcome right = chi_square_on_square(sample, uniform, {});
    EXPECT_TRUE(right.passes(sidak_alpha(0.01, test_count))) << right;
    const auto sloped = [](double x, double y) { return x + y < 1 ? 1.98 + 0.06 * x : 0.0; };
    const ChiSquareOutcome wrong = chi_square_on_square(sample, sloped, {.samples = 4000000});
    EXPECT_FALSE(wrong.passes(0.01)) << wrong;
}

/// Density of a direction whose ray from the origin meets the triangle.
double direction_pdf(const TriangleLight& light, const Vec3d& from, const Vec3d& direction) {
    const auto wide = [](const float* v) { return Vec3d{v[0], v[1], v[2]}; };
    const Vec3d e1 = wide(light.e1);
    const Vec3d e2 = wide(light.e2);
    const Vec3d to_corner = wide(light.p0) - from;
    const Vec3d normal = cross(e1, e2);
    const double along = dot(direction, normal);
    const double t = dot(to_corner, normal) / along;
    if (!(t > 0)) return 0;
    const Vec3d inside = direction * t - to_corner;
    const double b1 = dot(cross(inside, e2), normal) / dot(normal, normal);
    const double b2 = dot(cross(e1, inside), normal) / dot(normal, normal);
    if (b1 < 0 || b2 < 0 || b1 + b2 > 1) return 0;
    return t * t / (std::abs(along) / length(normal) * light.area);
}

void expect_right(const Vec3d& from) {
    const TriangleLight light = test_light();
    const Vec3f eye{
        static_cast<float>(from.x), static_cast<float>(from.y), static_cast<float>(from.z)};
    const auto sample = [&](Pcg32& random) -> std::optional<Vec3d> {
        const auto s = sample_triangle_light<float>(&light, 0, random_square<float>(random), eye);
        const double expected = direction_pdf(
            light,
            from,
            normalize(Vec3d{s.point.x - from.x, s.point.y - from.y, s.point.z - from.z}));
        // A point on the edge may miss by rounding; the others must have the claimed density.
        if (expected > 0) {
            EXPECT_NEAR(s.pdf / expected, 1, 1e-3);
        }
        return Vec3d{s.direction.x, s.direction.y, s.direction.z};
    };
    const auto pdf = [&](const Vec3d& d) { return direction_pdf(light, from, d); };
    const ChiSquareOutcome outcome = chi_square_on_sphere(sample, pdf, {.axis = 1});
    EXPECT_TRUE(outcome.passes(sidak_alpha(0.01, test_count))) << outcome;
}

TEST(TriangleLightStatistics, DirectionsFromBelow) {
    expect_right({0, 0, 0});
}
TEST(TriangleLightStatistics, DirectionsFromAbove) {
    expect_right({1, 4, 1});
}
TEST(TriangleLightStatistics, DirectionsAtAGrazingAngle) {
    expect_right({5, 1.5, 0});
}

TEST(TriangleLightStatistics, WrongDensityFails) {
    const TriangleLight light = test_light();
    const auto sample = [&](Pcg32& random) -> std::optional<Vec3d> {
        return sample_triangle_light<double>(&light, 0, random_square<double>(random), {0, 0, 0})
            .direction;
    };
    const Vec3d beside{0.02, 0, 0};
    const auto pdf = [&](const Vec3d& d) { return direction_pdf(light, beside, d); };
    const ChiSquareOutcome outcome =
        chi_square_on_sphere(sample, pdf, {.samples = 200000, .axis = 1});
    EXPECT_FALSE(outcome.passes(0.01)) << outcome;
}

}  // namespace
}  // namespace obscura
