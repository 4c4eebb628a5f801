// tests/shape/splat_test.cpp - splats against a search for the greatest response along the ray.
// SPDX-License-Identifier: Apache-2.0
#include "shape/splat.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include <array>
#include <cmath>

namespace obscura {
namespace {

/// A rotation and three standard deviations, of which ball_from_world is made.
struct Ellipsoid {
    Vec3d mean;
    std::array<Vec3d, 3> axes;  ///< unit
    std::array<double, 3> sigma;
    double opacity;
};

Vec3d random_vector(Pcg32& random, double size) {
    const auto number = [&] { return size * (2 * random.next_double() - 1); };
    return {number(), number(), number()};
}

Ellipsoid random_ellipsoid(Pcg32& random, double flattest) {
    Ellipsoid out;
    out.mean = random_vector(random, 5);
    const Vec3d a = normalize(random_vector(random, 1));
    const Vec3d b = normalize(cross(a, random_vector(random, 1)));
    out.axes = {a, b, cross(a, b)};
    for (double& sigma : out.sigma)
        sigma = std::pow(flattest, random.next_double());
    out.opacity = 0.02 + 0.98 * random.next_double();
    return out;
}

template <typename F>
Splat<F> splat_of(const Ellipsoid& from) {
    const auto vector = [](const Vec3d& v) {
        return Vec3<F>{static_cast<F>(v.x), static_cast<F>(v.y), static_cast<F>(v.z)};
    };
    Splat<F> out;
    out.mean = vector(from.mean);
    for (size_t i = 0; i < 3; ++i)
        out.ball_from_world[i] = vector(from.axes[i] * (1 / from.sigma[i]));
    out.opacity = static_cast<F>(from.opacity);
    return out;
}

double squared_distance(const Ellipsoid& e, const Vec3d& at) {
    double sum = 0;
    for (size_t i = 0; i < 3; ++i)
        sum += square(dot(e.axes[i], at - e.mean) / e.sigma[i]);
    return sum;
}

/// Golden section between two points far on both sides.
SplatPassage<double> search(const Ellipsoid& e, const ShapeRay<double>& ray) {
    const auto value = [&](double t) {
        return squared_distance(e, ray.origin + ray.direction * t);
    };
    constexpr double golden = 0.6180339887498949;
    double low = -100;
    double high = 100;
    for (int i = 0; i < 100; ++i) {
        const double a = high - golden * (high - low);
        const double b = low + golden * (high - low);
        (value(a) < value(b) ? high : low) = value(a) < value(b) ? b : a;
    }
    const double t = (low + high) / 2;
    return {t, e.opacity * std::exp(-value(t) / 2)};
}

TEST(Splat, TakesAsMuchAsItsGreatestResponse) {
    Pcg32 random(11);
    int met = 0;
    for (int i = 0; i < 4000; ++i) {
        const Ellipsoid e = random_ellipsoid(random, i % 2 == 0 ? 1e-4 : 0.2);
        const Vec3d beside = random_vector(random, i % 2 == 0 ? 0.02 : 1);
        const Vec3d origin = random_vector(random, 20);
        const ShapeRay<double> ray{origin, normalize(e.mean + beside - origin)};
        const SplatPassage<double> truth = search(e, ray);
        const SplatPassage<double> exact = pass_splat(splat_of<double>(e), ray);
        const double squared = 2 * std::log(e.opacity / truth.alpha);
        const double drawn = squared <= 9 && truth.alpha >= 1.0 / 255 ? truth.alpha : 0;
        if (std::abs(squared - 9) < 1e-4 || std::abs(truth.alpha * 255 - 1) < 1e-4) continue;
        EXPECT_NEAR(exact.alpha, drawn, 1e-6);
        if (drawn == 0) continue;
        EXPECT_NEAR(exact.t, truth.t, 1e-4);
        ++met;
    }
    EXPECT_GT(met, 500);
}

TEST(Splat, SinglePrecisionSeesThinOnesFromFarAway) {
    Pcg32 random(12);
    for (int i = 0; i < 2000; ++i) {
        const Ellipsoid e = random_ellipsoid(random, 1e-3);
        const Vec3d origin = random_vector(random, 100);
        const Vec3f start{static_cast<float>(origin.x),
                          static_cast<float>(origin.y),
                          static_cast<float>(origin.z)};
        const Splat<float> splat = splat_of<float>(e);
        const ShapeRay<float> ray{start, normalize(splat.mean - start)};
        EXPECT_NEAR(pass_splat(splat, ray).alpha, e.opacity, 0.01 * e.opacity)
            << "through its middle, " << length(origin - e.mean) << " m away";
    }
}

TEST(Splat, BlocksAreColumnsOfThem) {
    Pcg32 random(13);
    std::array<float, splat_block_floats> block = {};
    std::array<Splat<float>, splat_block> splats;
    for (size_t i = 0; i < splats.size(); ++i) {
        splats[i] = splat_of<float>(random_ellipsoid(random, 0.2));
        const Vec3f* m = splats[i].ball_from_world;
        const std::array<float, splat_columns> column = {splats[i].mean.x,
                                                         splats[i].mean.y,
                                                         splats[i].mean.z,
                                                         m[0].x,
                                                         m[0].y,
                                                         m[0].z,
                                                         m[1].x,
                                                         m[1].y,
                                                         m[1].z,
                                                         m[2].x,
                                                         m[2].y,
                                                         m[2].z,
                                                         splats[i].opacity};
        for (size_t c = 0; c < column.size(); ++c)
            block[c * splat_block + i] = column[c];
    }
    const ShapeRay<float> ray{{7, 1, 2}, normalize(Vec3f{-1, -0.2F, -0.3F})};
    const auto all = [](const Vec3f& v) { return Vec3<Lanes>{Lanes(v.x), Lanes(v.y), Lanes(v.z)}; };
    for (int first = 0; first < splat_block; first += lane_count) {
        const SplatPassage<Lanes> got =
            pass_splat(read_splats(block.data(), first), {all(ray.origin), all(ray.direction)});
        alignas(64) float alpha[lane_count];
        store(alpha, got.alpha);
        for (int lane = 0; lane < lane_count; ++lane) {
            const SplatPassage<float> one =
                pass_splat(splats[static_cast<size_t>(first + lane)], ray);
            EXPECT_NEAR(alpha[lane], one.alpha, 1e-5F);
        }
    }
}

TEST(Splat, SplatsThatAreNotThereTakeNothing) {
    const Splat<float> nothing{{0, 0, 0}, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, 0};
    EXPECT_EQ(pass_splat(nothing, {{0, 0, 5}, {0, 0, -1}}).alpha, 0);
}

}  // namespace
}  // namespace obscura
