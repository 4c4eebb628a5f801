// tests/math/warp_test.cpp - maps from the square to directions, and frames around a normal.
// SPDX-License-Identifier: Apache-2.0
#include "math/warp.h"

#include <gtest/gtest.h>

#include "support/lane_arrays.h"
#include "support/random.h"
#include <cmath>
#include <vector>

namespace obscura {
namespace {

using test::lane;

void expect_sine_and_cosine(float t) {
    const double angle = 2 * pi_d * static_cast<double>(t);
    const SinCos<float> one = sin_cos_turn(t);
    ASSERT_NEAR(one.sin, std::sin(angle), 4e-7) << t;
    ASSERT_NEAR(one.cos, std::cos(angle), 4e-7) << t;
    const SinCos<Lanes> many = sin_cos_turn(Lanes(t));
    ASSERT_NEAR(lane(many.sin, 0), std::sin(angle), 4e-7) << t;
    ASSERT_NEAR(lane(many.cos, 0), std::cos(angle), 4e-7) << t;
    const SinCos<double> wide = sin_cos_turn(static_cast<double>(t));
    ASSERT_NEAR(wide.sin, std::sin(angle), 1e-15) << t;
}

TEST(Warp, SineAndCosineOfATurn) {
    constexpr int steps = 100000;
    for (int i = 0; i <= steps; ++i)
        expect_sine_and_cosine(static_cast<float>(i) / steps);
    for (int eighth = 0; eighth <= 8; ++eighth) {  // where the series changes
        const float t = static_cast<float>(eighth) / 8.0F;
        expect_sine_and_cosine(t);
        if (eighth > 0) expect_sine_and_cosine(std::nextafter(t, 0.0F));
        if (eighth < 8) expect_sine_and_cosine(std::nextafter(t, 2.0F));
    }
    EXPECT_EQ(sin_cos_turn(0.0F).sin, 0.0F);
    EXPECT_EQ(sin_cos_turn(0.25F).sin, 1.0F);
    EXPECT_EQ(sin_cos_turn(0.5F).cos, -1.0F);
}

/// Unit normals: random ones, the axes, and those next to the poles.
std::vector<Vec3d> normals() {
    std::vector<Vec3d> out = {{0, 0, 1},
                              {0, 0, -1},
                              {1, 0, 0},
                              {-1, 0, 0},
                              {0, 1, 0},
                              {0, -1, 0},
                              {1, 0, -0.0},
                              {0, -1, -0.0}};
    for (const double tilt : {1e-1, 1e-3, 1e-5, 1e-7, 1e-20}) {
        for (const double pole : {-1.0, 1.0}) {
            out.push_back(normalize(Vec3d{tilt, -0.5 * tilt, pole}));
            out.push_back(normalize(Vec3d{1, 0.3, pole * tilt}));
        }
    }
    Pcg32 random(1);
    for (int n = 0; n < 20000; ++n) {
        const double x = random.next_double();
        out.push_back(uniform_sphere(Vec2<double>{x, random.next_double()}));
    }
    return out;
}

template <typename F>
void expect_frame(const Frame<F>& f, F bound) {
    ASSERT_NEAR(length(f.tangent), 1, bound) << f.normal.z;
    ASSERT_NEAR(length(f.bitangent), 1, bound) << f.normal.z;
    ASSERT_NEAR(dot(f.tangent, f.bitangent), 0, bound) << f.normal.z;
    ASSERT_NEAR(dot(f.tangent, f.normal), 0, bound) << f.normal.z;
    ASSERT_NEAR(dot(f.bitangent, f.normal), 0, bound) << f.normal.z;
    // Right-handed: tangent x bitangent is the normal.
    ASSERT_NEAR(length(cross(f.tangent, f.bitangent) - f.normal), 0, bound) << f.normal.z;
}

TEST(Warp, FramesAreOrthonormalAndRightHanded) {
    for (const Vec3d& n : normals()) {
        expect_frame(frame_around(n), 1e-14);
        const Vec3f narrow{
            static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
        expect_frame(frame_around(narrow), 1e-6F);
        const auto f = frame_around(Vec3<Lanes>{narrow.x, narrow.y, narrow.z});
        expect_frame(Frame<float>{lane(f.tangent, 0), lane(f.bitangent, 0), lane(f.normal, 0)},
                     1e-6F);
    }
}

TEST(Warp, LocalAndWorldAreInverse) {
    Pcg32 random(2);
    for (const Vec3d& n : normals()) {
        const auto frame = frame_around(n);
        const double x = random.next_double();
        const Vec3d v{x, random.next_double(), -1};
        ASSERT_LT(length(to_local(frame, to_world(frame, v)) - v), 1e-13);
        ASSERT_LT(length(to_world(frame, Vec3d{0, 0, 1}) - n), 1e-15);
    }
}

/// First and second moments of a map over a fine grid.
template <typename Map>
void expect_moments(const Map& map, double mean_z, double xx, double zz) {
    constexpr int side = 600;
    Vec3d sum{0, 0, 0};
    Vec3d squares{0, 0, 0};
    double mixed = 0;
    for (int i = 0; i < side * side; ++i) {
        const Vec2f u{(static_cast<float>(i % side) + 0.5F) / side,
                      (static_cast<float>(i / side) + 0.5F) / side};
        const Vec3f d = map(u);
        const Vec3d wide{d.x, d.y, d.z};
        ASSERT_NEAR(length(wide), 1, 1e-6);
        sum = sum + wide;
        squares = squares + wide * wide;
        mixed += wide.x * wide.y + wide.y * wide.z + wide.x * wide.z;
    }
    constexpr double n = static_cast<double>(side) * side;
    EXPECT_NEAR(sum.x / n, 0, 1e-5);
    EXPECT_NEAR(sum.y / n, 0, 1e-5);
    EXPECT_NEAR(sum.z / n, mean_z, 1e-4);
    EXPECT_NEAR(squares.x / n, xx, 1e-4);
    EXPECT_NEAR(squares.y / n, xx, 1e-4);
    EXPECT_NEAR(squares.z / n, zz, 1e-4);
    EXPECT_NEAR(mixed / n, 0, 1e-5);
}

TEST(Warp, CosineHemisphereHasItsMoments) {
    expect_moments([](const Vec2f& u) { return cosine_hemisphere(u); }, 2.0 / 3, 0.25, 0.5);
}

TEST(Warp, UniformSphereHasItsMoments) {
    expect_moments([](const Vec2f& u) { return uniform_sphere(u); }, 0, 1.0 / 3, 1.0 / 3);
}

TEST(Warp, CornersOfTheSquareAreSafe) {
    const float last = std::nextafter(1.0F, 0.0F);
    for (const float x : {0.0F, last}) {
        for (const float y : {0.0F, last}) {
            const Vec3f up = cosine_hemisphere(Vec2f{x, y});
            EXPECT_GT(up.z, 0.0F) << x;
            EXPECT_NEAR(length(up), 1.0F, 1e-6F);
            EXPECT_NEAR(length(uniform_sphere(Vec2f{x, y})), 1.0F, 1e-6F);
        }
    }
}

TEST(Warp, NormalizeKeepsTheZeroVector) {
    EXPECT_EQ(length(normalize(Vec3f{0, 0, 0})), 0.0F);
    EXPECT_NEAR(length(normalize(Vec3f{1e-15F, -2e-15F, 0})), 1.0F, 1e-6F);
    EXPECT_NEAR(length(normalize(Vec3f{1e18F, 1e18F, -1e18F})), 1.0F, 1e-6F);
}

}  // namespace
}  // namespace obscura
