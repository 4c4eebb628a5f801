// tests/statistics/shape_light_test.cpp - chi-square of directions towards emissive shapes.
// SPDX-License-Identifier: Apache-2.0
#include "light/shape_light.h"

#include "shape/disk.h"
#include "shape/plane.h"
#include "shape/sphere.h"

#include <gtest/gtest.h>

#include "support/chi_square.h"

namespace obscura {
namespace {

constexpr int test_count = 8;  ///< right densities below

ShapeLight sphere_lamp() {
    ShapeLight light;
    light.centre[1] = 2;
    light.area = 4 * pi_f;
    light.two_sided = 1;
    return light;
}

/// 2 m by 3 m in the plane y = 1.
ShapeLight flat_lamp(ShapeLightKind kind) {
    ShapeLight light;
    light.kind = static_cast<int32_t>(kind);
    light.centre[1] = 1;
    light.x[0] = 1;
    light.z[2] = kind == ShapeLightKind::ellipse ? 1.0F : 1.5F;
    light.area = kind == ShapeLightKind::ellipse ? pi_f : 6.0F;
    light.two_sided = 1;
    return light;
}

template <typename F>
ShapeLightValues<F> values_of_light(const ShapeLight& light) {
    return read_shape_light(TableRecord<F, ShapeLight>(&light, 0));
}

/// Where a direction meets a light, by the ray formulas; nothing where it misses.
std::optional<Vec3d> meet(const ShapeLight& light, const Vec3d& from, const Vec3d& direction) {
    const Vec3d centre{light.centre[0], light.centre[1], light.centre[2]};
    const ShapeRay<double> ray{from, direction};
    Roots<double> roots;
    if (light.kind == static_cast<int32_t>(ShapeLightKind::sphere)) {
        roots = intersect_sphere(Sphere<double>{centre, light.radius}, ray);
    } else if (light.kind == static_cast<int32_t>(ShapeLightKind::ellipse)) {
        roots = intersect_disk(Disk<double>{centre, light.x[0], 0}, ray);
    } else {
        roots = intersect_plane(Plane<double>{centre, light.x[0], light.z[2]}, ray);
    }
    const NearHit<double> hit = nearest(roots, 1e-9, 1e30);
    if (!hit.found) return std::nullopt;
    return from + direction * hit.t;
}

double density(const ShapeLight& light, const Vec3d& from, const Vec3d& direction) {
    const std::optional<Vec3d> point = meet(light, from, direction);
    if (!point) return 0;
    const bool round = light.kind == static_cast<int32_t>(ShapeLightKind::sphere);
    const Vec3d centre{light.centre[0], light.centre[1], light.centre[2]};
    const Vec3d normal = round ? normalize(*point - centre) : Vec3d{0, 1, 0};
    return shape_light_density(
        values_of_light<double>(light), from, length(*point - from), -dot(normal, direction));
}

void expect_right(const ShapeLight& light, const Vec3d& from, int axis = 1) {
    const Vec3f eye{
        static_cast<float>(from.x), static_cast<float>(from.y), static_cast<float>(from.z)};
    const auto sample = [&](Pcg32& random) -> std::optional<Vec3d> {
        const float x = random.next_float();
        const auto s =
            sample_shape_light(values_of_light<float>(light), Vec2f{x, random.next_float()}, eye);
        const Vec3d direction{s.direction.x, s.direction.y, s.direction.z};
        const double expected = density(light, from, direction);
        // Directions on the outline may miss by rounding; the others have the claimed density.
        if (expected > 0) {
            EXPECT_NEAR(s.pdf / expected, 1, 2e-3);
        }
        return direction;
    };
    const auto pdf = [&](const Vec3d& d) { return density(light, from, d); };
    const ChiSquareOutcome outcome = chi_square_on_sphere(sample, pdf, {.axis = axis});
    EXPECT_TRUE(outcome.passes(sidak_alpha(0.01, test_count))) << outcome;
}

TEST(ShapeLightStatistics, SphereFromBeside) {
    expect_right(sphere_lamp(), {0.5, 0, 0.3});
}
TEST(ShapeLightStatistics, SphereFromInside) {
    expect_right(sphere_lamp(), {0.2, 2.5, -0.3});
}
TEST(ShapeLightStatistics, RectangleFromBelow) {
    expect_right(flat_lamp(ShapeLightKind::rectangle), {0, 0, 0});
}
TEST(ShapeLightStatistics, RectangleFromAboveAndBeside) {
    expect_right(flat_lamp(ShapeLightKind::rectangle), {1.5, 1.7, -0.4});
}
TEST(ShapeLightStatistics, RectangleAtAGrazingAngle) {
    expect_right(flat_lamp(ShapeLightKind::rectangle), {2, 0.8, 1});
}
TEST(ShapeLightStatistics, ParallelogramByArea) {
    expect_right(flat_lamp(ShapeLightKind::parallelogram), {0.5, 0, -0.5});
}
TEST(ShapeLightStatistics, DiskFromBelow) {
    expect_right(flat_lamp(ShapeLightKind::ellipse), {0.3, 0, 0.2});
}

TEST(ShapeLightStatistics, FarSpheresKeepTheirSolidAngle) {
    for (const float distance : {10.0F, 1e3F, 1e5F}) {
        const double ratio = 1.0 / static_cast<double>(distance);
        const double cap = ratio * ratio / (1 + std::sqrt(1 - ratio * ratio));
        EXPECT_NEAR(sphere_cap(1.0F, distance) / cap, 1.0, 1e-5);
    }
}

TEST(ShapeLightStatistics, WrongDensityFails) {
    const ShapeLight light = sphere_lamp();
    const auto sample = [&](Pcg32& random) -> std::optional<Vec3d> {
        const double x = random.next_double();
        return sample_shape_light(
                   values_of_light<double>(light), Vec2<double>{x, random.next_double()}, {0, 0, 0})
            .direction;
    };
    const auto pdf = [&](const Vec3d& d) { return density(light, {0.02, 0, 0}, d); };
    const ChiSquareOutcome outcome =
        chi_square_on_sphere(sample, pdf, {.samples = 200000, .axis = 1});
    EXPECT_FALSE(outcome.passes(0.01)) << outcome;
}

}  // namespace
}  // namespace obscura
