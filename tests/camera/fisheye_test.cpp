// tests/camera/fisheye_test.cpp - the laws of angle and radius, within a ten-thousandth of a pixel.
// SPDX-License-Identifier: Apache-2.0
#include "camera/fisheye.h"

#include "camera/camera_models.h"

#include <gtest/gtest.h>

#include <functional>

namespace obscura::test {
namespace {

struct LawCase {
    const char* name;
    FisheyeLaw law;
    double fov_deg;
    std::function<double(double)> radius;  ///< of an angle
};

double polynomial(double theta) {
    double sum = 1;
    double power = 1;
    for (const double k : some_k) {
        power *= theta * theta;
        sum += static_cast<double>(static_cast<float>(k)) * power;
    }
    return theta * sum;
}

std::vector<LawCase> law_cases() {
    std::vector<LawCase> out;
    for (const double fov : {90.0, 180.0, 220.0, 300.0, 350.0}) {
        out.push_back({"equidistant", FisheyeLaw::equidistant, fov, [](double t) { return t; }});
        out.push_back({"equisolid", FisheyeLaw::equisolid, fov, [](double t) {
                           return 2 * std::sin(t / 2);
                       }});
        out.push_back({"stereographic", FisheyeLaw::stereographic, fov, [](double t) {
                           return 2 * std::tan(t / 2);
                       }});
        out.push_back({"opencv", FisheyeLaw::opencv, std::min(fov, 260.0), polynomial});
    }
    for (const double fov : {60.0, 120.0, 180.0}) {
        out.push_back(
            {"orthographic", FisheyeLaw::orthographic, fov, [](double t) { return std::sin(t); }});
    }
    return out;
}

/// Measures each ray's angle to the axis and compares its radius by the law with its film point,
/// over the whole image.
TEST(Fisheye, TheAngleDecidesTheRadiusOverTheWholeImage) {
    for (const LawCase& c : law_cases()) {
        SCOPED_TRACE(std::string(c.name) + " " + std::to_string(c.fov_deg));
        Camera camera = fisheye_camera(c.law, c.fov_deg, some_k);
        camera.world_from_camera = {};
        const double edge_px = film_height / 2.0;
        const double focal_px = edge_px / static_cast<double>(camera.fisheye.half_height);
        for (int y = 0; y < film_height; y += 7) {
            for (int x = 0; x < film_width; x += 7) {
                const double dx = x + 0.5 - film_width / 2.0;
                const double dy = y + 0.5 - film_height / 2.0;
                const double from_centre = std::hypot(dx, dy);
                const CameraRay<double> ray = generate_ray(
                    camera, Vec2<double>{(x + 0.5) / film_width, (y + 0.5) / film_height});
                if (std::abs(from_centre - edge_px) > 1e-3) {
                    EXPECT_EQ(ray.valid, from_centre < edge_px);
                }
                if (!ray.valid) continue;
                const double theta =
                    std::atan2(std::hypot(ray.direction.x, ray.direction.y), -ray.direction.z);
                EXPECT_NEAR(c.radius(theta) * focal_px, from_centre, 1e-4);
                EXPECT_NEAR(ray.direction.x * dy, -ray.direction.y * dx, 1e-7 * edge_px);
            }
        }
    }
}

TEST(Fisheye, TheEdgeOfTheCircleIsHalfTheFieldOfView) {
    for (const LawCase& c : law_cases()) {
        SCOPED_TRACE(std::string(c.name) + " " + std::to_string(c.fov_deg));
        Camera camera = fisheye_camera(c.law, c.fov_deg, some_k);
        camera.world_from_camera = {};
        const CameraRay<double> top = generate_ray(camera, Vec2<double>{0.5, 1e-9});
        ASSERT_TRUE(top.valid);
        const double theta = std::atan2(top.direction.y, -top.direction.z);
        const double wanted = c.fov_deg / 360 * pi_d;
        // At the end of sin(theta) the angle depends on the radius without bounds.
        EXPECT_NEAR(theta < 0 ? theta + 2 * pi_d : theta, wanted, c.fov_deg == 180 ? 1e-3 : 2e-6);
    }
}

TEST(Fisheye, LawsEndWhereTheyStopGrowing) {
    EXPECT_DOUBLE_EQ(largest_fisheye_angle(FisheyeLaw::equidistant, no_k), pi_d);
    EXPECT_DOUBLE_EQ(largest_fisheye_angle(FisheyeLaw::orthographic, no_k), pi_d / 2);
    EXPECT_LT(largest_fisheye_angle(FisheyeLaw::stereographic, no_k), pi_d);
    const double folding[4] = {-0.2, 0, 0, 0};  // r' = 1 - 0.6 theta^2
    EXPECT_NEAR(largest_fisheye_angle(FisheyeLaw::opencv, folding), std::sqrt(1 / 0.6), 1e-9);
    EXPECT_DOUBLE_EQ(largest_fisheye_angle(FisheyeLaw::opencv, no_k), pi_d);
}

TEST(Fisheye, TheImageIsUpright) {
    Camera camera = fisheye_camera(FisheyeLaw::equisolid, 180, no_k);
    camera.world_from_camera = {};
    EXPECT_GT(generate_ray(camera, Vec2<double>{0.6, 0.5}).direction.x, 0.1);
    EXPECT_GT(generate_ray(camera, Vec2<double>{0.5, 0.4}).direction.y, 0.1);
    EXPECT_NEAR(generate_ray(camera, Vec2<double>{0.5, 0.5}).direction.z, -1, 1e-12);
}

}  // namespace
}  // namespace obscura::test
