// tests/camera/camera_test.cpp - camera rays and matrices against closed forms in double.
// SPDX-License-Identifier: Apache-2.0
#include "camera/camera.h"

#include "camera/camera_models.h"
#include "camera/matrices.h"
#include "camera/project.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace obscura {
namespace {

constexpr int width = 640;
constexpr int height = 360;
constexpr double aspect = static_cast<double>(width) / height;

/// A camera turned by three angles about Y, X, Z and moved.
Affined turned(double yaw, double pitch, double roll, const Vec3d& position) {
    const auto rotation = [](int a, int b, double angle) {
        Affined r;
        r.m[a][a] = std::cos(angle);
        r.m[a][b] = -std::sin(angle);
        r.m[b][a] = std::sin(angle);
        r.m[b][b] = std::cos(angle);
        return r;
    };
    Affined out =
        compose(rotation(2, 0, yaw), compose(rotation(1, 2, pitch), rotation(0, 1, roll)));
    out.m[0][3] = position.x;
    out.m[1][3] = position.y;
    out.m[2][3] = position.z;
    return out;
}

Camera make_camera(CameraModel model) {
    Camera camera;
    camera.model = model;
    camera.world_from_camera = affine_cast<float>(turned(0.7, -0.4, 0.2, {3, -2, 5}));
    camera.pinhole.tan_half_yfov = 0.35f;
    camera.pinhole.aspect = static_cast<float>(aspect);
    camera.pinhole.pixel_spread = 0.7f / height;
    camera.orthographic.half_height_m = 2.5f;
    camera.orthographic.half_width_m = static_cast<float>(2.5 * aspect);
    camera.orthographic.pixel_width_m = 5.0f / height;
    return camera;
}

/// A world position in the space of a matrix for row vectors: p' = p * M, divided by w.
Vec3d times(const Vec3d& p, const RowMatrix4& matrix) {
    const double in[4] = {p.x, p.y, p.z, 1};
    double out[4] = {};
    for (size_t c = 0; c < 4; ++c) {
        for (size_t r = 0; r < 4; ++r)
            out[c] += in[r] * static_cast<double>(matrix[4 * r + c]);
    }
    return {out[0] / out[3], out[1] / out[3], out[2] / out[3]};
}

class BothModels : public testing::TestWithParam<CameraModel> {};
INSTANTIATE_TEST_SUITE_P(Camera,
                         BothModels,
                         testing::Values(CameraModel::pinhole, CameraModel::orthographic));

TEST_P(BothModels, APointOnARayProjectsToTheRaysPixel) {
    const Camera camera = make_camera(GetParam());
    const CameraMatrices matrices = camera_matrices(camera, 0.1, 100);
    Pcg32 random(1);
    for (int i = 0; i < 1000; ++i) {
        const Vec2<double> film{random.next_float(), random.next_float()};
        const double distance = 1 + 20 * static_cast<double>(random.next_float());
        const CameraRay<double> ray = generate_ray(camera, film);
        const Vec3d ndc =
            times(ray.origin + distance * ray.direction, matrices.world_to_ndc.value());
        EXPECT_NEAR(ndc.x * width, film.x * width, 2e-3);
        EXPECT_NEAR(ndc.y * height, film.y * height, 2e-3);
        EXPECT_GT(ndc.z, 0);
        EXPECT_LT(ndc.z, 1);
    }
}

TEST_P(BothModels, FloatRaysMatchDoubleRays) {
    const Camera camera = make_camera(GetParam());
    Pcg32 random(2);
    for (int i = 0; i < 1000; ++i) {
        const Vec2<float> film{random.next_float(), random.next_float()};
        const CameraRay<float> ray = generate_ray(camera, film);
        const CameraRay<double> truth =
            generate_ray(camera, Vec2<double>{static_cast<double>(film.x), film.y});
        const auto widen = [](const Vec3f& v) { return Vec3d{v.x, v.y, v.z}; };
        EXPECT_LT(length(widen(ray.direction) - truth.direction), 5e-7);
        EXPECT_LT(length(widen(ray.origin) - truth.origin), 3e-6);
        EXPECT_NEAR(length(truth.direction), 1, 2e-7);
    }
}

TEST_P(BothModels, NeighbouringRaysAreOneFootprintApart) {
    const Camera camera = make_camera(GetParam());
    const Vec2<double> middle{0.5, 0.5};
    const Vec2<double> below{0.5, 0.5 + 1.0 / height};
    const CameraRay<double> a = generate_ray(camera, middle);
    const CameraRay<double> b = generate_ray(camera, below);
    const double distance = 10;
    const double apart =
        length(a.origin + distance * a.direction - b.origin - distance * b.direction);
    EXPECT_NEAR(a.cone_width + distance * a.cone_spread, apart, 1e-4 * apart);
}

TEST(Pinhole, TheCentreLooksDownMinusZAndTheTopCornerIsUpLeft) {
    Camera camera = make_camera(CameraModel::pinhole);
    camera.world_from_camera = {};
    const CameraRay<double> centre = generate_ray(camera, Vec2<double>{0.5, 0.5});
    EXPECT_NEAR(centre.direction.z, -1, 1e-12);
    const CameraRay<double> corner = generate_ray(camera, Vec2<double>{0, 0});
    const double half_height = static_cast<double>(camera.pinhole.tan_half_yfov);
    EXPECT_NEAR(corner.direction.x / -corner.direction.z, -half_height * aspect, 1e-6);
    EXPECT_NEAR(corner.direction.y / -corner.direction.z, half_height, 1e-9);
}

/// The closed form of glTF 2.0, section 3.10.3, for a known point.
TEST(Orthographic, SizeDoesNotDependOnDistance) {
    // 6 m are 480 pixels: a metre is 80 of them to the right and upwards, near and far.
    Camera camera;
    camera.model = CameraModel::orthographic;
    camera.orthographic = {4, 3, 6.0f / 480};
    for (const double distance : {0.1, 1.0, 30.0, 1000.0}) {
        const Vec2<double> film = project(camera, {1, 1, -distance}).value();
        EXPECT_NEAR(film.x * 640, 320 + 80, 1e-4) << distance;
        EXPECT_NEAR(film.y * 480, 240 - 80, 1e-4) << distance;
    }
}

TEST(Matrices, AKnownPointLandsOnItsPixel) {
    Camera camera = make_camera(CameraModel::pinhole);
    camera.world_from_camera = affine_cast<float>(turned(0, 0, 0, {1, 2, 3}));
    camera.pinhole.tan_half_yfov = 0.5f;
    camera.pinhole.aspect = 2;
    const CameraMatrices matrices = camera_matrices(camera, 1, 9);
    // 4 m ahead the film is 8 m wide and 4 m high, from the corner at (-4, 2) of the camera. The
    // point is 0.5 m right of its middle and 0.25 m above: 4.5 / 8 to the right, 1.75 / 4 down.
    const Vec3d ndc = times({1.5, 2.25, -1}, matrices.world_to_ndc.value());
    EXPECT_NEAR(ndc.x, 0.5625, 1e-6);
    EXPECT_NEAR(ndc.y, 0.4375, 1e-6);
    // 1 / depth falls evenly from 1 at the near plane to 1/9 at the far one: (1 - 1/4) / (1 - 1/9).
    EXPECT_NEAR(ndc.z, 0.84375, 1e-6);
}

TEST(Matrices, NdcIsWhereTheRendererProjects) {
    std::vector<std::string> with_ndc;
    for (const auto& [name, camera] : test::all_cameras()) {
        SCOPED_TRACE(name);
        const CameraMatrices matrices = camera_matrices(camera, 0.1, 100);
        if (!matrices.world_to_ndc) continue;
        with_ndc.push_back(name);
        Pcg32 random(3);
        for (int i = 0; i < 500; ++i) {
            const auto at = [&] { return 2 * static_cast<double>(random.next_float()) - 1; };
            const Vec3d ahead{8 * at(), 6 * at(), -10 + 8 * at()};
            const Vec3d world =
                transform_point(affine_cast<double>(camera.world_from_camera), ahead);
            const auto film = project(camera, world);
            ASSERT_TRUE(film);
            const Vec3d ndc = times(world, *matrices.world_to_ndc);
            EXPECT_NEAR(ndc.x, film->x, 2e-5);
            EXPECT_NEAR(ndc.y, film->y, 2e-5);
        }
    }
    EXPECT_EQ(with_ndc,
              (std::vector<std::string>{"pinhole", "shifted", "thin lens", "orthographic"}));
}

TEST(Matrices, OrthographicDepthIsLinear) {
    Camera camera = make_camera(CameraModel::orthographic);
    camera.world_from_camera = {};
    const RowMatrix4 ndc = camera_matrices(camera, 2, 6).world_to_ndc.value();
    EXPECT_NEAR(times({0, 0, -2}, ndc).z, 0, 1e-6);
    EXPECT_NEAR(times({0, 0, -4}, ndc).z, 0.5, 1e-6);
    EXPECT_NEAR(times({0, 0, -6}, ndc).z, 1, 1e-6);
    EXPECT_NEAR(times({2.5 * aspect, 0, -3}, ndc).x, 1, 1e-6);
    EXPECT_NEAR(times({-2.5 * aspect, 0, -3}, ndc).x, 0, 1e-6);
    EXPECT_NEAR(times({0, 2.5, -3}, ndc).y, 0, 1e-6);
    EXPECT_NEAR(times({0, -2.5, -3}, ndc).y, 1, 1e-6);
}

/// OpenEXR's camera space: +x right, +y up, +z ahead.
TEST(Matrices, WhatIsAheadHasPositiveDepth) {
    // At (1, 2, 3), looking along +X: the right hand is at +Z.
    Camera camera = make_camera(CameraModel::pinhole);
    camera.world_from_camera =
        affine_cast<float>(Affined{{{0, 0, -1, 1}, {0, 1, 0, 2}, {1, 0, 0, 3}}});
    const RowMatrix4 to_camera = camera_matrices(camera, 0.1, 100).world_to_camera;
    const std::pair<Vec3d, Vec3d> known[] = {{{6, 2, 3}, {0, 0, 5}},
                                             {{6, 2, 4}, {1, 0, 5}},
                                             {{6, 3, 3}, {0, 1, 5}},
                                             {{0, 2, 3}, {0, 0, -1}}};
    for (const auto& [world, expected] : known)
        EXPECT_LT(length(times(world, to_camera) - expected), 1e-6) << world.x << " " << world.y;
}

/// The window on the plane one unit ahead is what the rays of the image's edges bound.
TEST(Matrices, TheScreenWindowIsWhatTheRaysBound) {
    std::vector<std::string> with_window;
    for (auto [name, camera] : test::all_cameras()) {
        SCOPED_TRACE(name);
        const auto window = camera_matrices(camera, 0.1, 100).screen_window;
        if (!window) continue;
        with_window.push_back(name);
        camera.world_from_camera = {};
        const auto on_plane = [&, &lens = camera](double x, double y) {
            const Vec3d ray = generate_ray(lens, Vec2<double>{x, y}).direction;
            return Vec2<double>{ray.x / -ray.z, ray.y / -ray.z};
        };
        const Vec2<double> low = on_plane(0, 1);
        const Vec2<double> high = on_plane(1, 0);
        EXPECT_NEAR(window->width, high.x - low.x, 1e-6);
        EXPECT_NEAR(window->center_x, -(low.x + high.x) / 2, 1e-6) << "+x is to the left";
        EXPECT_NEAR(window->center_y, (low.y + high.y) / 2, 1e-6);
    }
    EXPECT_EQ(with_window, (std::vector<std::string>{"pinhole", "shifted", "thin lens"}));
}

}  // namespace
}  // namespace obscura
