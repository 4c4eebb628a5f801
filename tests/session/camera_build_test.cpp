// tests/session/camera_build_test.cpp - settings become cameras: angles, openings, circles, turns.
// SPDX-License-Identifier: Apache-2.0
#include "session/camera_build.h"

#include "camera/lens_equation.h"
#include "camera/project.h"

#include <gtest/gtest.h>

#include <cmath>

namespace obscura {
namespace {

constexpr ImageSize size = {600, 400};

Camera build(CameraModel model, const CameraSettings& settings, ImageSize image = size) {
    CameraBasis basis;
    basis.tan_half_yfov = 0.4;
    const Result<Camera> camera = make_camera(basis, model, settings, image);
    EXPECT_TRUE(camera) << camera.error().message;
    return camera ? *camera : Camera{};
}

TEST(CameraBuild, ARealLensHasItsFilmWhereTheFocusIs) {
    CameraSettings s;
    s.focal_length_m = 0.05;
    s.sensor_m = {{0.036, 0.024}};
    s.focus_distance_m = 1;
    EXPECT_NEAR(build(CameraModel::pinhole, s).pinhole.tan_half_yfov, 0.24, 1e-7);
    s.fstop = 2;
    const Camera lens = build(CameraModel::thin_lens, s);
    EXPECT_NEAR(lens.pinhole.tan_half_yfov, 0.012 / image_distance(0.05, 1), 1e-7);
    EXPECT_NEAR(lens.thin_lens.aperture.radius_m, 0.0125, 1e-8);
    s.fstop.reset();
    s.lens_radius_m = 0.01;
    EXPECT_NEAR(build(CameraModel::thin_lens, s).pinhole.tan_half_yfov, 0.24, 1e-7);
}

/// The circle of confusion in pixels, by the formula on the film and by the one of docs/cameras.md.
TEST(CameraBuild, TheFilmsMillimetresAndTheImagesPixelsAgree) {
    CameraSettings s;
    s.focal_length_m = 0.085;
    s.sensor_m = {{0.036, 0.024}};
    s.focus_distance_m = 1.5;
    s.fstop = 1.8;
    const Camera lens = build(CameraModel::thin_lens, s);
    const double opening = 0.085 / 1.8;
    for (const double z : {0.5, 1.0, 2.0, 9.0}) {
        const double on_film = circle_of_confusion(opening, 0.085, 1.5, z) / 0.024 * 400;
        const double in_pixels = opening * std::abs(1 / 1.5 - 1 / z) * 400 /
                                 (2 * static_cast<double>(lens.pinhole.tan_half_yfov));
        EXPECT_NEAR(on_film, in_pixels, 1e-5 * on_film);
    }
}

TEST(CameraBuild, WithoutAFocalLengthTheAngleHasTheOneOfSmallFilm) {
    CameraSettings s;
    s.fstop = 2;
    s.focus_distance_m = 1e9;
    const Camera lens = build(CameraModel::thin_lens, s);
    EXPECT_NEAR(lens.thin_lens.aperture.radius_m, 0.024 / (2 * 0.4) / 4, 1e-7);
    EXPECT_FLOAT_EQ(lens.pinhole.tan_half_yfov, 0.4f);
}

/// A point (x, y, z) in OpenCV's camera axes is seen at fx x / z + cx, fy y / z + cy.
TEST(CameraBuild, IntrinsicsPutPointsOnTheirPixels) {
    CameraSettings s;
    s.intrinsics = Intrinsics{1200, 800, 900, 950, 580, 430};
    for (const ImageSize image : {ImageSize{1200, 800}, ImageSize{600, 400}}) {
        const Camera camera = build(CameraModel::pinhole, s, image);
        const double scale = image.width_px / 1200.0;
        for (const Vec3d& p : {Vec3d{0.2, -0.1, 2}, Vec3d{-1, 0.8, 3}, Vec3d{0, 0, 1}}) {
            const auto film = project(camera, {p.x, -p.y, -p.z});
            ASSERT_TRUE(film);
            EXPECT_NEAR(film->x * image.width_px, scale * (900 * p.x / p.z + 580), 1e-4);
            EXPECT_NEAR(film->y * image.height_px, scale * (950 * p.y / p.z + 430), 1e-4);
        }
    }
}

TEST(CameraBuild, AShiftMovesThePrincipalPoint) {
    CameraSettings s;
    s.shift = {{0.25, -0.1}};
    const auto film = project(build(CameraModel::pinhole, s), {0, 0, -1});
    EXPECT_NEAR(film->x, 0.25, 1e-7);
    EXPECT_NEAR(film->y, 0.4, 1e-7);
}

TEST(CameraBuild, AFisheyesCircleTouchesTheShorterSidesOrTheCorners) {
    CameraSettings s;
    s.fisheye_fov_rad = 220 * pi_d / 180;
    for (const FisheyeLaw law : {FisheyeLaw::equidistant, FisheyeLaw::stereographic}) {
        s.fisheye = law;
        s.fisheye_fit = FisheyeFit::circle;
        const double edge = 110 * pi_d / 180 * (1 - 1e-6);
        const Vec3d place{0, std::sin(edge), -std::cos(edge)};
        EXPECT_NEAR(project(build(CameraModel::fisheye, s), place)->y, 0, 1e-5);
        s.fisheye_fit = FisheyeFit::diagonal;
        const double w = 600 / std::hypot(600, 400) * std::sin(edge);
        const double h = 400 / std::hypot(600, 400) * std::sin(edge);
        const auto corner = project(build(CameraModel::fisheye, s), {w, h, -std::cos(edge)});
        EXPECT_NEAR(corner->x, 1, 1e-5);
        EXPECT_NEAR(corner->y, 0, 1e-5);
    }
}

TEST(CameraBuild, AroundIsTurnedToTheWorldUnlessItLooksAhead) {
    CameraSettings s;
    const Camera world = build(CameraModel::environment, s);
    EXPECT_NEAR(project(world, {1, 0, 0})->x, 0.5, 1e-9);
    EXPECT_NEAR(project(world, {0, 0, 1})->x, 0.75, 1e-9);
    s.align = EnvironmentAlign::view;
    EXPECT_NEAR(project(build(CameraModel::environment, s), {0, 0, -1})->x, 0.5, 1e-9);
}

TEST(CameraBuild, AnExposureNeedsItsThreeNumbersOrOne) {
    CameraSettings s;
    EXPECT_EQ(*chosen_exposure(s), std::nullopt);
    s.shutter_s = 0.01;
    EXPECT_EQ(chosen_exposure(s).error().id, "E-CAM-EXPOSURE");
    s.fstop = 1;
    EXPECT_NEAR(**chosen_exposure(s), std::log2(100), 1e-12);
    s.ev100 = 3;
    EXPECT_EQ(**chosen_exposure(s), 3);
}

}  // namespace
}  // namespace obscura
