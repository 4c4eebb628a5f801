// tests/shape/surface_test.cpp - points on shapes: normals, texture coordinates and tangents.
// SPDX-License-Identifier: Apache-2.0
#include "shape/shape_truth.h"

#include <gtest/gtest.h>

#include "support/lane_arrays.h"

namespace obscura {
namespace {

using namespace test;

template <typename F>
SurfacePoint<F> surface(const ShapeRecord& record, const Vec3<F>& at) {
    return surface_of_shape<F>(IntOf<F>(record.kind), UniformShape<F>(record), at);
}

/// Calls body(shape, place) for points all over every shape.
template <typename Body>
void for_places(const Body& body) {
    for (const NamedShape& shape : sample_shapes()) {
        Pcg32 random(21);
        int found = 0;
        for (int i = 0; i < 3000; ++i) {
            const ShapeRay<float> ray = random_ray(shape.record, 3.0F, random);
            const ShapeRay<double> wide = ray_cast_to<double>(ray);
            const Roots<double> roots = intersect_shape<double>(shape.record, wide);
            for (int k = 0; k < 2; ++k) {
                if (!roots.hit[k]) continue;
                ++found;
                body(shape, wide.origin + wide.direction * roots.t[k]);
                if (testing::Test::HasFatalFailure()) return;
            }
        }
        EXPECT_GT(found, 100) << shape.name;
    }
}

bool is_quadric(const ShapeRecord& record) {
    return record.kind == static_cast<int32_t>(ShapeKind::quadric) ||
           record.kind == static_cast<int32_t>(ShapeKind::quadric_from_above);
}

TEST(Surface, NormalsPointOutwards) {
    for_places([](const NamedShape& shape, const Vec3d& at) {
        const SurfacePoint<double> s = surface(shape.record, at);
        ASSERT_NEAR(length(s.normal), 1.0, 1e-9);
        const double up = implicit_value(shape.record, at + s.normal * 1e-5);
        const double down = implicit_value(shape.record, at - s.normal * 1e-5);
        ASSERT_GT(up, down) << shape.name;
        if (is_quadric(shape.record)) return;  // its value is no distance
        ASSERT_NEAR(up, 1e-5, 2e-7) << shape.name;
    });
}

TEST(Surface, PointsAreBroughtBackToTheSurface) {
    for_places([](const NamedShape& shape, const Vec3d& at) {
        const Vec3f off{static_cast<float>(at.x) + 1e-5F,
                        static_cast<float>(at.y) - 1e-5F,
                        static_cast<float>(at.z) + 1e-5F};
        const SurfacePoint<float> s = surface(shape.record, off);
        const Vec3d p{s.position.x, s.position.y, s.position.z};
        const double slope =
            is_quadric(shape.record)
                ? length(quadric_gradient(read_quadric<double>(UniformShape<double>(shape.record)),
                                          p - Vec3d{shape.record.centre[0],
                                                    shape.record.centre[1],
                                                    shape.record.centre[2]}))
                : 1.0;
        const double away = std::abs(implicit_value(shape.record, p)) / slope;
        ASSERT_LT(away, static_cast<double>(s.error) + 1e-7) << shape.name;
        ASSERT_LT(static_cast<double>(s.error), 2e-5) << shape.name;
    });
}

TEST(Surface, TextureCoordinatesGrowAlongTheirTangents) {
    for_places([](const NamedShape& shape, const Vec3d& at) {
        const SurfacePoint<double> s = surface(shape.record, at);
        const double step = 1e-6;
        const SurfacePoint<double> right = surface(shape.record, s.position + s.dpdu * step);
        const SurfacePoint<double> down = surface(shape.record, s.position + s.dpdv * step);
        const double du = right.uv.x - s.uv.x;
        const double dv = down.uv.y - s.uv.y;
        if (std::abs(du) > 0.5) return;  // across the seam
        if (dot(right.normal, s.normal) < 0.99 || dot(down.normal, s.normal) < 0.99)
            return;                      // edge
        if (is_quadric(shape.record)) {  // sizes are kept from growing where the surface turns away
            ASSERT_GT(du, -1e-9) << shape.name;
            ASSERT_GT(dv, -1e-9) << shape.name;
            return;
        }
        ASSERT_NEAR(du / step, 1.0, 2e-3) << shape.name;
        ASSERT_NEAR(dv / step, 1.0, 2e-3) << shape.name;
        ASSERT_NEAR((right.uv.y - s.uv.y) / step, 0.0, 2e-3) << shape.name;
        // A texture seen from the front is not mirrored.
        ASSERT_LT(dot(cross(s.normal, s.dpdu), s.dpdv), 0.0) << shape.name;
    });
}

TEST(Surface, LanesSayWhatDoublesSay) {
    for_places([](const NamedShape& shape, const Vec3d& at) {
        const SurfacePoint<double> one = surface(shape.record, at);
        const Vec3<Lanes> place{Lanes(static_cast<float>(at.x)),
                                Lanes(static_cast<float>(at.y)),
                                Lanes(static_cast<float>(at.z))};
        const SurfacePoint<Lanes> many = surface(shape.record, place);
        const auto gap = [](const Vec3<Lanes>& a, const Vec3d& b) {
            const Vec3f v = lane(a, 0);
            return length(Vec3d{v.x, v.y, v.z} - b);
        };
        ASSERT_LT(gap(many.position, one.position), 1e-5) << shape.name;
        if (gap(many.normal, one.normal) > 0.1) return;  // an edge: either side will do
        ASSERT_LT(gap(many.normal, one.normal), 1e-3) << shape.name;
    });
}

TEST(Surface, AGlobeFacesPlusZ) {
    const ShapeRecord globe = shape_record(ShapeKind::sphere, 1, 0, 0);
    EXPECT_NEAR(surface(globe, Vec3d{0, 0, 1}).uv.x, 0.5, 1e-7);
    EXPECT_NEAR(surface(globe, Vec3d{1, 0, 0}).uv.x, 0.75, 1e-7);
    EXPECT_NEAR(surface(globe, Vec3d{-1, 0, 0}).uv.x, 0.25, 1e-7);
    EXPECT_NEAR(surface(globe, Vec3d{0, 1, 0}).uv.y, 0.0, 1e-7);
    EXPECT_NEAR(surface(globe, Vec3d{0, -1, 0}).uv.y, 1.0, 1e-7);
    const SurfacePoint<double> pole = surface(globe, Vec3d{0, 1, 0});
    EXPECT_GT(length(pole.dpdu), 1e-6);
    EXPECT_GT(length(pole.dpdv), 1e-6);
}

TEST(Surface, InfinitePlanesRepeatEveryMetre) {
    const ShapeRecord plane = shape_record(ShapeKind::plane, unbounded, unbounded, 0);
    EXPECT_TRUE(is_unbounded(plane));
    const SurfacePoint<double> s = surface(plane, Vec3d{7.25, 0, -3.5});
    EXPECT_NEAR(s.uv.x, 7.25, 1e-9);
    EXPECT_NEAR(s.uv.y, -3.5, 1e-9);
}

TEST(ShapeRecord, BoxesHoldTheirShapes) {
    for_places([](const NamedShape& shape, const Vec3d& at) {
        const ShapeBox box = shape_bounds(shape.record);
        const double low[3] = {box.low.x, box.low.y, box.low.z};
        const double high[3] = {box.high.x, box.high.y, box.high.z};
        const double p[3] = {at.x, at.y, at.z};
        for (int i = 0; i < 3; ++i) {
            ASSERT_GT(p[i], low[i]) << shape.name;
            ASSERT_LT(p[i], high[i]) << shape.name;
        }
    });
}

TEST(ShapeRecord, ScaledShapesAreHitWhereScaledRaysWouldBe) {
    for (const NamedShape& shape : sample_shapes()) {
        const ShapeRecord big = scaled_and_moved(shape.record, 2.5, {1, 2, 3});
        Pcg32 random(22);
        for (int i = 0; i < 300; ++i) {
            const ShapeRay<double> ray =
                ray_cast_to<double>(random_ray(shape.record, 3.0F, random));
            const ShapeRay<double> moved_ray{ray.origin * 2.5 + Vec3d{1, 2, 3},
                                             ray.direction * 2.5};
            const Roots<double> small = intersect_shape<double>(shape.record, ray);
            const Roots<double> large = intersect_shape<double>(big, moved_ray);
            for (int k = 0; k < 2; ++k) {
                if (!small.hit[k] || !large.hit[k]) continue;
                ASSERT_NEAR(small.t[k], large.t[k], 1e-3) << shape.name;
            }
        }
    }
}

}  // namespace
}  // namespace obscura
