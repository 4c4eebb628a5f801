// tests/shape/intersect_test.cpp - rays against every shape: in double, then float and lanes.
// SPDX-License-Identifier: Apache-2.0
#include "shape/shape_truth.h"
#include "shape/triangle.h"

#include <gtest/gtest.h>

#include "support/lane_arrays.h"

namespace obscura {
namespace {

using namespace test;

constexpr float distances[] = {0.0F, 3.0F, 100.0F};

Vec3d at(const ShapeRay<double>& ray, double t) {
    return ray.origin + ray.direction * t;
}

/// The double formulas against the shapes' definitions.
void expect_roots_on_surface(const NamedShape& shape, const ShapeRay<double>& ray) {
    const Roots<double> roots = intersect_shape<double>(shape.record, ray);
    const double size = 1.0 + length(ray.origin);
    for (int i = 0; i < 2; ++i) {
        if (!roots.hit[i]) continue;
        const Vec3d p = at(ray, roots.t[i]);
        ASSERT_NEAR(implicit_value(shape.record, p), 0.0, 2e-8 * size) << shape.name;
        ASSERT_TRUE(within_limits(shape.record, p, 1e-9 * size)) << shape.name;
    }
    ASSERT_FALSE(roots.hit[0] && roots.hit[1] && roots.t[0] > roots.t[1]) << shape.name;
}

TEST(Shapes, RootsInDoubleLieOnTheSurface) {
    for (const NamedShape& shape : sample_shapes()) {
        Pcg32 random(11);
        for (int i = 0; i < 3000; ++i) {
            const ShapeRay<float> ray = random_ray(shape.record, distances[i % 3], random);
            ASSERT_NO_FATAL_FAILURE(expect_roots_on_surface(shape, ray_cast_to<double>(ray)));
        }
    }
}

TEST(Shapes, NoRootIsForgotten) {
    // Wherever the definition changes sign along a line there is a root: steps find most of them.
    for (const NamedShape& shape : sample_shapes()) {
        Pcg32 random(12);
        for (int i = 0; i < 400; ++i) {
            const ShapeRay<float> narrow = random_ray(shape.record, distances[i % 2], random);
            const ShapeRay<double> ray = ray_cast_to<double>(narrow);
            const Roots<double> roots = intersect_shape<double>(shape.record, ray);
            const double step = 0.02 / length(ray.direction);
            double before = implicit_value(shape.record, at(ray, -1e-4));
            for (double t = -1e-4 + step; t < 6.0 / length(ray.direction); t += step) {
                const double after = implicit_value(shape.record, at(ray, t));
                const bool crossed = (before < 0) != (after < 0) &&
                                     within_limits(shape.record, at(ray, t), -0.03) &&
                                     within_limits(shape.record, at(ray, t - step), -0.03);
                const auto near = [&](int k) {
                    return roots.hit[k] && roots.t[k] > t - 1.001 * step &&
                           roots.t[k] < t + 1e-3 * step;
                };
                ASSERT_TRUE(!crossed || near(0) || near(1)) << shape.name << " ray " << i;
                before = after;
            }
        }
    }
}

/// Agreement of single precision with double on one ray; `miss_slack`: lines that pass this close
/// to the outline (relative to the shape's size) may go either way.
struct Agreement {
    int rays = 0;
    int hits = 0;
    int differing = 0;
    double worst_t = 0;  ///< error of t in metres, relative to distance plus size of the shape
};

void compare(const Roots<double>& truth, const Roots<float>& got, double length, Agreement& sum) {
    ++sum.rays;
    for (int i = 0; i < 2; ++i) {
        if (truth.hit[i] != got.hit[i]) {
            ++sum.differing;
            continue;
        }
        if (!truth.hit[i]) continue;
        ++sum.hits;
        const double error = std::abs(static_cast<double>(got.t[i]) - truth.t[i]) * length;
        sum.worst_t = std::max(sum.worst_t, error / (1.0 + std::abs(truth.t[i]) * length));
    }
}

Agreement compare_many(const ShapeRecord& record, float distance, int count) {
    Pcg32 random(13);
    Agreement sum;
    for (int i = 0; i < count; ++i) {
        const ShapeRay<float> ray = random_ray(record, distance, random);
        const Roots<double> truth = intersect_shape<double>(record, ray_cast_to<double>(ray));
        // Where a line only touches, t depends on the last bit; those are counted by the miss.
        if (truth.hit[0] && truth.t[0] < truth.t[1] &&
            (truth.t[1] - truth.t[0]) * static_cast<double>(length(ray.direction)) < 0.02) {
            continue;
        }
        compare(truth,
                intersect_shape<float>(record, ray),
                static_cast<double>(length(ray.direction)),
                sum);
    }
    return sum;
}

TEST(Shapes, SinglePrecisionAgreesWithDouble) {
    for (const NamedShape& shape : sample_shapes()) {
        for (const float distance : {0.0F, 3.0F, 1e3F, 1e6F}) {
            const Agreement sum = compare_many(shape.record, distance, 20000);
            EXPECT_GT(sum.hits, sum.rays / 20) << shape.name << " from " << distance;
            EXPECT_LE(sum.differing, 4) << shape.name << " from " << distance;
            EXPECT_LT(sum.worst_t, 5e-5) << shape.name << " from " << distance;
        }
    }
}

TEST(Shapes, LanesSayWhatScalarsSay) {
    for (const NamedShape& shape : sample_shapes()) {
        Pcg32 random(14);
        for (int i = 0; i < 500; ++i) {
            std::vector<ShapeRay<float>> rays;
            for (int k = 0; k < lane_count; ++k)
                rays.push_back(random_ray(shape.record, distances[i % 3], random));
            const auto column = [&](const auto& member) {
                return make_lanes([&](int k) { return member(rays[static_cast<size_t>(k)]); });
            };
            using R = ShapeRay<float>;
            const ShapeRay<Lanes> ray{{column([](const R& r) { return r.origin.x; }),
                                       column([](const R& r) { return r.origin.y; }),
                                       column([](const R& r) { return r.origin.z; })},
                                      {column([](const R& r) { return r.direction.x; }),
                                       column([](const R& r) { return r.direction.y; }),
                                       column([](const R& r) { return r.direction.z; })}};
            const Roots<Lanes> many = intersect_shape<Lanes>(shape.record, ray);
            for (int k = 0; k < lane_count; ++k) {
                const Roots<float> one =
                    intersect_shape<float>(shape.record, rays[static_cast<size_t>(k)]);
                for (int root = 0; root < 2; ++root) {
                    if (!one.hit[root] || !lane(many.hit[root], k)) continue;
                    const float t = lane(many.t[root], k);
                    ASSERT_NEAR(t, one.t[root], 1e-4F * (1.0F + std::fabs(t))) << shape.name;
                }
            }
        }
    }
}

TEST(Sphere, FromAMillionRadiiAway) {
    const ShapeRecord record = shape_record(ShapeKind::sphere, 1, 0, 0);
    Pcg32 random(15);
    int hits = 0;
    for (int i = 0; i < 1000000; ++i) {
        const ShapeRay<float> ray = random_ray(record, 1e6F, random);
        const ShapeRay<double> wide = ray_cast_to<double>(ray);
        const Roots<double> truth = intersect_shape<double>(record, wide);
        const Roots<float> got = intersect_shape<float>(record, ray);
        const double passes =
            length(exact_cross(wide.origin, wide.direction)) / length(wide.direction);
        ASSERT_TRUE(got.hit[0] || passes > 1 - 1e-5) << passes;
        ASSERT_FALSE(got.hit[0] && passes >= 1 + 1e-5) << passes;
        if (!got.hit[0] || !truth.hit[0]) continue;
        ++hits;
        const double t = truth.t[0];
        ASSERT_LT(std::abs(static_cast<double>(got.t[0]) - t) / t, 1e-6);
    }
    EXPECT_GT(hits, 500000);
}

TEST(Sphere, FromInsideOneRootLiesAhead) {
    const ShapeRecord record = shape_record(ShapeKind::sphere, 2, 0, 0);
    const Roots<float> roots = intersect_shape<float>(record, {{0.5F, 0, 0}, {1, 0, 0}});
    EXPECT_FLOAT_EQ(roots.t[0], -2.5F);
    EXPECT_FLOAT_EQ(roots.t[1], 1.5F);
    const NearHit<float> ahead = nearest(roots, 0.0F, no_limit);
    EXPECT_TRUE(ahead.found);
    EXPECT_FLOAT_EQ(ahead.t, 1.5F);
    EXPECT_FALSE(nearest(roots, 0.0F, 1.0F).found);
    EXPECT_FALSE(nearest(roots, 1.6F, no_limit).found);
    EXPECT_FLOAT_EQ(nearest(roots, -3.0F, no_limit).t, -2.5F);
}

TEST(Triangle, BarycentricWeightsRebuildThePoint) {
    Pcg32 random(16);
    const auto point = [&] {
        const double x = random.next_double();
        const double y = random.next_double();
        return Vec3d{x, y, random.next_double()};
    };
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const Triangle<double> triangle{point(), point(), point()};
        const double u = 1.4 * random.next_double() - 0.2;
        const double v = 1.4 * random.next_double() - 0.2;
        const Vec3d target =
            triangle.a + (triangle.b - triangle.a) * u + (triangle.c - triangle.a) * v;
        const Vec3d origin = point() + Vec3d{0, 0, 3};
        const ShapeRay<double> ray{origin, target - origin};
        const TriangleHit<double> hit = intersect_triangle(triangle, ray);
        const double area = length(cross(triangle.b - triangle.a, triangle.c - triangle.a));
        if (area < 1e-2) continue;
        const bool inside = u >= 0 && v >= 0 && u + v <= 1;
        const double edge = std::min({std::abs(u), std::abs(v), std::abs(1 - u - v)});
        ASSERT_TRUE(hit.hit == inside || edge < 1e-9) << u << " " << v;
        if (!hit.hit) continue;
        ++hits;
        ASSERT_NEAR(hit.t, 1.0, 1e-9);
        ASSERT_NEAR(hit.beta, u, 1e-9);
        ASSERT_NEAR(hit.gamma, v, 1e-9);
    }
    EXPECT_GT(hits, 4000);
}

TEST(Quadratic, SmallRootsSurviveLargeOnes) {
    // t^2 - 1e8 t + 1 = 0: the schoolbook formula finds 0 in single precision.
    const Quadratic<float> q = solve_quadratic(1.0F, -0.5e8F, 1.0F);
    EXPECT_TRUE(q.real);
    EXPECT_FLOAT_EQ(q.t.low, 1e-8F);
    EXPECT_FLOAT_EQ(q.t.high, 1e8F);
}

}  // namespace
}  // namespace obscura
