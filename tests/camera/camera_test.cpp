// tests/camera/camera_test.cpp - camera rays and matrices against closed forms in double.
// SPDX-License-Identifier: Apache-2.0
#include "camera/camera.h"

#include "camera/matrices.h"
#include "camera/project.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include <cmath>

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

struct Projected {
    double x_px, y_px, z_ndc;
};

/// Projects with the row-vector matrix that images carry: p' = p * M.
Projected project(const CameraMatrices& matrices, const Vec3d& p) {
    const double in[4] = {p.x, p.y, p.z, 1};
    double out[4] = {};
    for (int c = 0; c < 4; ++c) {
        for (int r = 0; r < 4; ++r) {
            out[c] += in[r] * static_cast<double>(matrices.world_to_ndc[4 * r + c]);
        }
    }
    return {(out[0] / out[3] + 1) / 2 * width, (1 - out[1] / out[3]) / 2 * height, out[2] / out[3]};
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
        const Projected got = project(matrices, ray.origin + distance * ray.direction);
        EXPECT_NEAR(got.x_px, film.x * width, 2e-3);
        EXPECT_NEAR(got.y_px, film.y * height, 2e-3);
        EXPECT_GT(got.z_ndc, -1);
        EXPECT_LT(got.z_ndc, 1);
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
    // In camera space (0.5, 0.25, -4): x' = 0.5 / (0.5 * 2 * 4) = 1/8, y' = 0.25 / (0.5 * 4) = 1/8.
    const Projected got = project(matrices, {1.5, 2.25, -1});
    EXPECT_NEAR(got.x_px, (1 + 1.0 / 8) / 2 * width, 1e-4);
    EXPECT_NEAR(got.y_px, (1 - 1.0 / 8) / 2 * height, 1e-4);
    // z' = ((f + n) / (n - f) * z + 2 f n / (n - f)) / -z, with n = 1, f = 9, z = -4.
    EXPECT_NEAR(got.z_ndc, (-1.25 * -4 - 2.25) / 4, 1e-6);
}

TEST(Matrices, OrthographicDepthIsLinear) {
    Camera camera = make_camera(CameraModel::orthographic);
    camera.world_from_camera = {};
    const CameraMatrices matrices = camera_matrices(camera, 2, 6);
    EXPECT_NEAR(project(matrices, {0, 0, -2}).z_ndc, -1, 1e-6);
    EXPECT_NEAR(project(matrices, {0, 0, -4}).z_ndc, 0, 1e-6);
    EXPECT_NEAR(project(matrices, {0, 0, -6}).z_ndc, 1, 1e-6);
    EXPECT_NEAR(project(matrices, {2.5 * aspect, 0, -3}).x_px, width, 1e-4);
    EXPECT_NEAR(project(matrices, {0, 2.5, -3}).y_px, 0, 1e-4);
}

TEST(Matrices, WorldToCameraUndoesTheCamerasPlace) {
    const Camera camera = make_camera(CameraModel::pinhole);
    const CameraMatrices matrices = camera_matrices(camera, 0.1, 100);
    const Vec3f in_camera{0.5f, -1, -7};
    const Vec3f world = transform_point(camera.world_from_camera, in_camera);
    const float p[4] = {world.x, world.y, world.z, 1};
    const float expected[4] = {in_camera.x, in_camera.y, in_camera.z, 1};
    for (int c = 0; c < 4; ++c) {
        float sum = 0;
        for (int r = 0; r < 4; ++r)
            sum += p[r] * matrices.world_to_camera[4 * r + c];
        EXPECT_NEAR(sum, expected[c], 3e-6f);
    }
}

}  // namespace
}  // namespace obscura
