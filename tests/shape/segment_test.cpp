// tests/shape/segment_test.cpp - a curve segment in any direction is the hull of its two spheres.
// SPDX-License-Identifier: Apache-2.0
#include "shape/segment.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include <algorithm>
#include <cmath>

namespace obscura {
namespace {

Vec3d random_vector(Pcg32& random) {
    const double x = 2 * random.next_double() - 1;
    const double y = 2 * random.next_double() - 1;
    return {x, y, 2 * random.next_double() - 1};
}

/// Distance to the hull of two spheres, the union of all spheres in between: the least distance to
/// any of them, by bisection, because it is convex along the segment.
double distance_to(const Segment<double>& s, const Vec3d& p) {
    const auto at = [&](double share) {
        const Vec3d centre = s.from + (s.to - s.from) * share;
        const double radius = s.radius_from + (s.radius_to - s.radius_from) * share;
        return length(p - centre) - radius;
    };
    double low = 0;
    double high = 1;
    for (int i = 0; i < 200; ++i) {
        const double a = low + (high - low) / 3;
        const double b = high - (high - low) / 3;
        (at(a) < at(b) ? high : low) = at(a) < at(b) ? b : a;
    }
    return at(0.5 * (low + high));
}

Segment<double> random_segment(Pcg32& random) {
    Segment<double> s{random_vector(random), random_vector(random), 0, 0};
    const double way = length(s.to - s.from);
    s.radius_from = 0.4 * random.next_double() * way + 0.01;
    s.radius_to = 0.4 * random.next_double() * way + 0.01;
    return s;
}

TEST(Segment, RootsLieOnTheHull) {
    Pcg32 random(5);
    int hits = 0;
    for (int i = 0; i < 4000; ++i) {
        const Segment<double> s = random_segment(random);
        const Vec3d origin = random_vector(random) * 5.0;
        const ShapeRay<double> ray{origin, random_vector(random) - origin};
        const Roots<double> roots = intersect_segment(frame_of(s), ray);
        double nearest = INFINITY;
        for (int k = 0; k <= 400; ++k) {
            nearest = std::min(nearest, distance_to(s, ray.origin + ray.direction * (k / 200.0)));
        }
        if (!roots.hit[0]) {
            EXPECT_GT(nearest, -1e-9) << i;
            continue;
        }
        ++hits;
        for (const double t : roots.t)
            ASSERT_NEAR(distance_to(s, ray.origin + ray.direction * t), 0, 1e-7) << i;
        EXPECT_LE(distance_to(s, ray.origin + ray.direction * (0.5 * (roots.t[0] + roots.t[1]))),
                  0);
    }
    EXPECT_GT(hits, 400);
}

TEST(Segment, FrameTurnsAndReturns) {
    Pcg32 random(6);
    for (int i = 0; i < 200; ++i) {
        const Segment<double> s = random_segment(random);
        const SegmentFrame<double> frame = frame_of(s);
        const Vec3d top =
            frame.centre + out_of_frame(frame, Vec3d{0, frame.capsule.half_height, 0});
        EXPECT_NEAR(length(top - s.to), 0, 1e-12);
        const Vec3d v = random_vector(random);
        EXPECT_NEAR(length(out_of_frame(frame, into_frame(frame, v)) - v), 0, 1e-12);
        const Vec3d x = out_of_frame(frame, Vec3d{1, 0, 0});
        const Vec3d y = out_of_frame(frame, Vec3d{0, 1, 0});
        EXPECT_NEAR(length(cross(x, y) - out_of_frame(frame, Vec3d{0, 0, 1})), 0, 1e-12);
        EXPECT_NEAR(fraction_along(frame, 0.5 * frame.capsule.half_height), 0.75, 1e-12);
        EXPECT_EQ(fraction_along(frame, -2 * frame.capsule.half_height), 0);
    }
}

/// A sphere that holds the other is shrunk, so that a cone around both is left.
TEST(Segment, NeitherSphereHoldsTheOther) {
    const SegmentFrame<double> frame = frame_of<double>({{0, 0, 0}, {0, 0, 1}, 5, 1});
    EXPECT_LT(frame.capsule.bottom - frame.capsule.top, 2 * frame.capsule.half_height);
    EXPECT_EQ(frame.capsule.top, 1);
    const Roots<double> roots = intersect_segment(frame, {{0, 9, 0}, {0, -1, 0}});
    EXPECT_TRUE(roots.hit[0]);
}

}  // namespace
}  // namespace obscura
