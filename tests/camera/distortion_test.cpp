// tests/camera/distortion_test.cpp - OpenCV's lens distortion, written out, and its inverse.
// SPDX-License-Identifier: Apache-2.0
#include "camera/distortion.h"

#include "camera/camera_models.h"

#include <gtest/gtest.h>

#include "support/random.h"

namespace obscura::test {
namespace {

struct Coefficients {
    double k1, k2, p1, p2, k3;
};

constexpr Coefficients cases[] = {{-0.3, 0.1, 0.001, -0.0005, 0.0},
                                  {0.25, -0.05, -0.002, 0.003, 0.01},
                                  {-0.4, 0.3, 0.0, 0.0, -0.05},
                                  {0.0, 0.0, 0.01, 0.02, 0.0}};

Distortion make(const Coefficients& c) {
    return {static_cast<float>(c.k1),
            static_cast<float>(c.k2),
            static_cast<float>(c.p1),
            static_cast<float>(c.p2),
            static_cast<float>(c.k3),
            static_cast<float>(largest_radius(c.k1, c.k2, c.k3, 100))};
}

/// The text of OpenCV's manual.
Vec2<double> forward(const Coefficients& c, double x, double y) {
    const double r2 = x * x + y * y;
    const double radial = 1 + c.k1 * r2 + c.k2 * r2 * r2 + c.k3 * r2 * r2 * r2;
    return {x * radial + 2 * c.p1 * x * y + c.p2 * (r2 + 2 * x * x),
            y * radial + c.p1 * (r2 + 2 * y * y) + 2 * c.p2 * x * y};
}

TEST(Distortion, IsOpenCvsFormulaWithItsDerivatives) {
    Pcg32 random(5);
    for (const Coefficients& c : cases) {
        for (int i = 0; i < 200; ++i) {
            const double x = 1.6 * static_cast<double>(random.next_float()) - 0.8;
            const double y = 1.6 * static_cast<double>(random.next_float()) - 0.8;
            const Distorted<double> got = distort(make(c), Vec2<double>{x, y});
            EXPECT_NEAR(got.position.x, forward(c, x, y).x, 1e-7);
            EXPECT_NEAR(got.position.y, forward(c, x, y).y, 1e-7);
            constexpr double h = 1e-5;
            EXPECT_NEAR(got.xx, (forward(c, x + h, y).x - forward(c, x - h, y).x) / (2 * h), 1e-6);
            EXPECT_NEAR(got.xy, (forward(c, x, y + h).x - forward(c, x, y - h).x) / (2 * h), 1e-6);
            EXPECT_NEAR(got.yy, (forward(c, x, y + h).y - forward(c, x, y - h).y) / (2 * h), 1e-6);
        }
    }
}

/// Within a ten-thousandth of a pixel at a focal length of 1000 pixels.
TEST(Distortion, IsUndone) {
    Pcg32 random(6);
    for (const Coefficients& c : cases) {
        const Distortion d = make(c);
        const double limit = std::min(static_cast<double>(d.radius_limit), 1.0);
        for (int i = 0; i < 2000; ++i) {
            const double radius =
                0.97 * limit * std::sqrt(static_cast<double>(random.next_float()));
            const double angle = 2 * pi_d * static_cast<double>(random.next_float());
            const Vec2<double> p{radius * std::cos(angle), radius * std::sin(angle)};
            const Distorted<double> wanted = distort(d, p);
            if (wanted.xx * wanted.yy - wanted.xy * wanted.yx < 0.01) continue;
            const Undistorted<double> got = undistort(d, wanted.position);
            EXPECT_TRUE(got.valid);
            EXPECT_LT(std::hypot(got.position.x - p.x, got.position.y - p.y) * 1000, 1e-4);
        }
    }
}

TEST(Distortion, WhatFoldsOverIsSeenNowhere) {
    // r (1 - 0.5 r^2) grows up to r = sqrt(2 / 3) and never exceeds 0.5443.
    const Distortion d = make({-0.5, 0, 0, 0, 0});
    EXPECT_NEAR(d.radius_limit, std::sqrt(2.0 / 3), 1e-6);
    EXPECT_TRUE(undistort(d, Vec2<double>{0.54, 0}).valid);
    for (const double r : {0.55, 0.8, 1.5, 20.0}) {
        const Undistorted<double> got = undistort(d, Vec2<double>{0.6 * r, 0.8 * r});
        EXPECT_FALSE(got.valid) << r;
        EXPECT_TRUE(std::isfinite(got.position.x + got.position.y));
        const Undistorted<float> narrow = undistort(d, Vec2<float>{static_cast<float>(r), 0.0f});
        EXPECT_FALSE(narrow.valid);
        EXPECT_TRUE(std::isfinite(narrow.position.x + narrow.position.y));
    }
    EXPECT_DOUBLE_EQ(largest_radius(0.1, 0, 0, 100), 100);
}

/// OpenCV counts y downwards: with p1 > 0 the middle of the upper edge moves down.
TEST(Distortion, YGrowsDownwards) {
    Camera camera = pinhole_camera();
    camera.world_from_camera = {};
    camera.distortion = make({0, 0, 0.05, 0, 0});
    const double y = 0.3;  // above the axis: -0.3 in OpenCV's axes
    const double expected = -forward({0, 0, static_cast<double>(0.05f), 0, 0}, 0, -y).y;
    const auto film = project(camera, {0, y, -1});
    ASSERT_TRUE(film);
    EXPECT_NEAR(film->y, (1 - expected / 0.5) / 2, 1e-9);
    EXPECT_LT(expected, y);
}

}  // namespace
}  // namespace obscura::test
