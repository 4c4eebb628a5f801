// tests/shape/degenerate_test.cpp - lines along rulings and axes, and surfaces that lines touch.
// SPDX-License-Identifier: Apache-2.0
#include "shape/shape_truth.h"

#include <gtest/gtest.h>

#include "support/lane_arrays.h"

namespace obscura {
namespace {

using namespace test;

constexpr float open_cylinder[10] = {1, 1, 0, 0, 0, 0, 0, 0, 0, -0.09F};  // along Z
constexpr float parabolic_cylinder[10] = {1, 0, 0, 0, 0, 0, 0, -1, 0, 0};
constexpr float hyperbolic_cylinder[10] = {1, -1, 0, 0, 0, 0, 0, 0, 0, -0.04F};
constexpr float slanted_plane[10] = {0, 0, 0, 0, 0, 0, 0.3F, 0.5F, -0.7F, 0.1F};
constexpr float plane_squared[10] = {0, 0, 1, 0, 0, 0, 0, 0, 0, 0};
constexpr float slanted_plane_squared[10] = {1, 1, 0, 2, 0, 0, 0, 0, 0, 0};  // (x + y)^2

/// One line as single precision, as each lane and as double precision meet it.
struct Met {
    Roots<float> single;
    Roots<double> exact;
    Roots<Lanes> lanes;
};

Met meet(const ShapeRecord& record, const ShapeRay<float>& ray) {
    const auto wide = [](const Vec3f& v) { return Vec3<Lanes>{v.x, v.y, v.z}; };
    return {intersect_shape<float>(record, ray),
            intersect_shape<double>(record, ray_cast_to<double>(ray)),
            intersect_shape<Lanes>(record, ShapeRay<Lanes>{wide(ray.origin), wide(ray.direction)})};
}

void expect_missed(const ShapeRecord& record, const ShapeRay<float>& ray) {
    const Met met = meet(record, ray);
    for (int k = 0; k < 2; ++k) {
        ASSERT_FALSE(met.single.hit[k]) << met.single.t[k];
        ASSERT_FALSE(met.exact.hit[k]) << met.exact.t[k];
        ASSERT_TRUE(none(met.lanes.hit[k]));
    }
}

float in_box(Pcg32& random) {
    return 0.9F * random.next_float() - 0.45F;
}

TEST(Degenerate, LinesAlongRulingsMeetNothing) {
    for (const auto* k : {&open_cylinder, &parabolic_cylinder, &hyperbolic_cylinder}) {
        const ShapeRecord record = quadric_record(*k, 0.5F, 0.5F, 0.5F);
        Pcg32 random(41);
        for (int i = 0; i < 2000; ++i) {
            const float x = in_box(random);
            const Vec3f origin{x, in_box(random), 4 * random.next_float() - 2};
            if (std::abs(implicit_value(record, {origin.x, origin.y, 0})) < 1e-6) continue;
            const Vec3f along{0, 0, random.next_float() < 0.5F ? -1.0F : 2.0F};
            ASSERT_NO_FATAL_FAILURE(expect_missed(record, {origin, along}));
            // Nearly so: the line meets the surface far outside of the box.
            const Vec3f nearly{1e-9F * x, 1e-10F, along.z};
            ASSERT_NO_FATAL_FAILURE(expect_missed(record, {origin, nearly}));
        }
    }
}

/// (1, 1, 0) and (0, 1, 2) are exactly along the first plane, and their products are exact.
TEST(Degenerate, LinesAlongAPlaneMeetNothingAndOthersMeetItOnce) {
    const float exact_plane[10] = {0, 0, 0, 0, 0, 0, 0.5F, -0.5F, 0.25F, 0.125F};
    const ShapeRecord record = quadric_record(exact_plane, 0.5F, 0.5F, 0.5F);
    const ShapeRecord slanted = quadric_record(slanted_plane, 0.5F, 0.5F, 0.5F);
    Pcg32 random(42);
    int met_once = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3f origin{in_box(random), in_box(random), in_box(random)};
        const Vec3f along = i % 2 == 0 ? Vec3f{1, 1, 0} : Vec3f{0, 1, 2};
        if (std::abs(implicit_value(record, {origin.x, origin.y, origin.z})) < 1e-6) continue;
        ASSERT_NO_FATAL_FAILURE(expect_missed(record, {origin, along}));
        const Vec3f across{in_box(random), in_box(random), in_box(random)};
        const Met met = meet(slanted, {origin, across});
        // n . (o + t d) + c = 0
        const Vec3d n{slanted.k[6], slanted.k[7], slanted.k[8]};
        const Vec3d o{origin.x, origin.y, origin.z};
        const Vec3d d{across.x, across.y, across.z};
        const double t = -(dot(n, o) + static_cast<double>(slanted.k[9])) / dot(n, d);
        const double outside = max_component(abs(o + d * t)) - 0.5;
        if (std::abs(dot(n, d)) < 1e-3 || std::abs(outside) < 1e-3) continue;
        ASSERT_EQ(met.single.hit[0] || met.single.hit[1], outside < 0);
        if (outside > 0) continue;
        ++met_once;
        ASSERT_NE(met.single.hit[0], met.single.hit[1]);
        ASSERT_NEAR(met.single.t[met.single.hit[0] ? 0 : 1], t, 1e-3 * (1 + std::abs(t)));
        ASSERT_NEAR(met.exact.t[met.exact.hit[0] ? 0 : 1], t, 1e-9 * (1 + std::abs(t)));
    }
    EXPECT_GT(met_once, 300);
}

/// The plane n . p = 0 squared: every line that crosses it inside of the box meets it, once, from
/// its front.
void expect_whole(const ShapeRecord& record, const Vec3d& n, float distance) {
    Pcg32 random(43);
    int count = 0;
    for (int i = 0; i < 4000; ++i) {
        const float x = random.next_float();
        const Vec3f way = uniform_sphere(Vec2f{x, random.next_float()});
        const Vec3d raw{in_box(random), in_box(random), in_box(random)};
        const Vec3d place = raw - n * (dot(raw, n) / dot(n, n));
        const Vec3d d{way.x, way.y, way.z};
        if (std::abs(dot(d, n)) < 0.05 || max_component(abs(place)) > 0.45) continue;
        const Vec3d from = place - d * static_cast<double>(distance);
        const ShapeRay<float> ray{
            {static_cast<float>(from.x), static_cast<float>(from.y), static_cast<float>(from.z)},
            way};
        const Vec3d o{ray.origin.x, ray.origin.y, ray.origin.z};
        const double t = -dot(o, n) / dot(d, n);
        const Met met = meet(record, ray);
        ++count;
        ASSERT_TRUE(met.single.hit[0] && met.exact.hit[0] && all(met.lanes.hit[0])) << i;
        ASSERT_NEAR(met.single.t[0], t, 1e-6 * (1 + 10 * std::abs(t))) << i;
        ASSERT_NEAR(lane(met.lanes.t[0], 0), t, 1e-6 * (1 + 10 * std::abs(t))) << i;
        ASSERT_NEAR(met.exact.t[0], t, 1e-12 * (1 + std::abs(t))) << i;
        ASSERT_EQ(is_front<float>(record, ray, met.single.t[0], 0), record.k[0] + record.k[2] > 0)
            << i;
    }
    ASSERT_GT(count, 1000);
}

TEST(Degenerate, APlaneSquaredIsOneWholeSurface) {
    for (const float distance : {0.0F, 3.0F, 1000.0F}) {
        for (const float sign : {1.0F, -1.0F}) {
            ShapeRecord level = quadric_record(plane_squared, 0.5F, 0.5F, 0.5F);
            ShapeRecord slanted = quadric_record(slanted_plane_squared, 0.5F, 0.5F, 0.5F);
            for (float& k : level.k)
                k *= sign;
            for (float& k : slanted.k)
                k *= sign;
            ASSERT_NO_FATAL_FAILURE(expect_whole(level, {0, 0, 1}, distance));
            ASSERT_NO_FATAL_FAILURE(expect_whole(slanted, {1, 1, 0}, distance));
        }
    }
}

/// (z + d)^2 in single precision has no roots, or two, by its coefficients' rounding.
TEST(Degenerate, APlaneSquaredBesideTheCentreIsWholeToo) {
    Pcg32 random(47);
    for (int i = 0; i < 2000; ++i) {
        const float d = in_box(random);
        const float k[10] = {0, 0, 1, 0, 0, 0, 0, 0, 2 * d, d * d};
        const ShapeRecord record = quadric_record(k, 0.5F, 0.5F, 0.5F);
        const Vec3f way{0.2F * in_box(random), 0.2F * in_box(random), -1};
        const Roots<float> roots = intersect_shape<float>(record, ShapeRay<float>{{0, 0, 1}, way});
        ASSERT_TRUE(roots.hit[0]) << d;
        ASSERT_NEAR(roots.t[0], 1 + d, 5e-7) << d;
    }
}

TEST(Degenerate, ThePlaneSquaredHasItsPlanesNormal) {
    for (const Vec3f& place : {Vec3f{0.1F, 0.2F, 0}, Vec3f{-0.3F, 0.2F, 1e-7F}}) {
        const ShapeRecord level = quadric_record(plane_squared, 0.5F, 0.5F, 0.5F);
        const SurfacePoint<float> on =
            surface_of_shape<float>(level.kind, UniformShape<float>(level), place);
        EXPECT_FLOAT_EQ(on.normal.z, 1);
        EXPECT_NEAR(length(on.position - place), 0, 1e-6);
    }
    const ShapeRecord slanted = quadric_record(slanted_plane_squared, 0.5F, 0.5F, 0.5F);
    const SurfacePoint<float> on = surface_of_shape<float>(
        slanted.kind, UniformShape<float>(slanted), Vec3f{0.3F, -0.3F, 0.1F});
    EXPECT_FLOAT_EQ(on.normal.x, std::sqrt(0.5F));
    EXPECT_FLOAT_EQ(on.normal.y, std::sqrt(0.5F));
}

/// x^2 = 10^-8: two planes that single precision cannot tell apart by the terms at the box's
/// middle.
TEST(Degenerate, PlanesCloseTogetherAreTwo) {
    const float k[10] = {1, 0, 0, 0, 0, 0, 0, 0, 0, -1e-8F};
    const ShapeRecord record = quadric_record(k, 0.5F, 0.5F, 0.5F);
    Pcg32 random(44);
    for (int i = 0; i < 1000; ++i) {
        const Vec3f origin{-0.45F, in_box(random), in_box(random)};
        const ShapeRay<float> ray{origin, {1, 0.1F * in_box(random), 0.1F * in_box(random)}};
        const Roots<float> roots = intersect_shape<float>(record, ray);
        ASSERT_TRUE(roots.hit[0] && roots.hit[1]);
        ASSERT_NEAR(roots.t[0], 0.45F - 1e-4F, 3e-7F);
        ASSERT_NEAR(roots.t[1], 0.45F + 1e-4F, 3e-7F);
    }
}

TEST(Degenerate, SolidsAlongTheirAxis) {
    const ShapeRecord cylinder = shape_record(ShapeKind::frustum, 0.7F, 0.5F, 0.5F);
    const ShapeRecord capsule = shape_record(ShapeKind::capsule, 0.6F, 0.4F, 0.4F);
    Pcg32 random(45);
    for (int i = 0; i < 2000; ++i) {
        const float x = 2 * in_box(random);
        const float z = 2 * in_box(random);
        const double r = std::hypot(x, z);
        const ShapeRay<float> down{{x, 3, z}, {0, -1, 0}};
        const Met flat = meet(cylinder, down);
        const Met round = meet(capsule, down);
        if (std::abs(r - 0.5) > 1e-5) {
            ASSERT_EQ(flat.single.hit[0], r < 0.5) << r;
        }
        if (std::abs(r - 0.4) > 1e-5) {
            ASSERT_EQ(round.single.hit[0], r < 0.4) << r;
        }
        if (flat.single.hit[0]) {
            ASSERT_NEAR(flat.single.t[0], 3 - 0.7F, 1e-6);
        }
        if (r < 0.399) {
            ASSERT_NEAR(round.single.t[0], 2.4 - std::sqrt(0.16 - r * r), 2e-6);
        }
    }
}

/// Parallel to the ruling of a cone from (1, -1, 0) to its apex, (0, 1, 0): the inside is found by
/// steps.
TEST(Degenerate, AConeAlongItsRulings) {
    const ShapeRecord cone = shape_record(ShapeKind::frustum, 1, 1, 0);
    Pcg32 random(46);
    int hits = 0;
    int misses = 0;
    for (int i = 0; i < 1000; ++i) {
        const Vec3f origin{1 + 2 * in_box(random), -2, 2 * in_box(random)};
        double least = 1;
        for (double t = 0.5; t <= 1.5; t += 0.001) {
            const Vec3d p{static_cast<double>(origin.x) - t, -2 + 2 * t, origin.z};
            least = std::min(least, implicit_value(cone, p));
        }
        if (std::abs(least) < 1e-3) continue;
        const Met met = meet(cone, {origin, {-1, 2, 0}});
        ASSERT_EQ(met.single.hit[0], least < 0);
        ASSERT_EQ(met.exact.hit[0], least < 0);
        ASSERT_EQ(any(met.lanes.hit[0]), least < 0);
        ++(least < 0 ? hits : misses);
    }
    EXPECT_GT(hits, 100);
    EXPECT_GT(misses, 100);
}

/// Along its axis, or very nearly so.
TEST(Degenerate, AConeAtItsApex) {
    const ShapeRecord cone = shape_record(ShapeKind::frustum, 0.475F, 0.42F, 0);
    Pcg32 random(47);
    for (int i = 0; i < 3000; ++i) {
        const float far_from_axis = i % 3 == 0 ? 0 : std::exp2(-30 * random.next_float());
        const Vec3f origin{0.1F * far_from_axis, 0.9F + random.next_float(), 0};
        const Vec3f direction{i % 3 == 2 ? 1e-3F * in_box(random) : 0, -1, 0};
        const Met met = meet(cone, {origin, direction});
        ASSERT_TRUE(met.exact.hit[0]);
        ASSERT_TRUE(met.single.hit[0]);
        ASSERT_TRUE(all(met.lanes.hit[0]));
        ASSERT_NEAR(met.single.t[0], met.exact.t[0], 1e-6) << origin.x;
        ASSERT_NEAR(lane(met.lanes.t[0], 0), met.exact.t[0], 1e-6) << origin.x;
    }
}

}  // namespace
}  // namespace obscura
