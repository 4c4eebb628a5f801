// tests/camera/thin_lens_test.cpp - the lens equation, the circle of confusion, and the lens' rays.
// SPDX-License-Identifier: Apache-2.0
#include "camera/thin_lens.h"

#include "camera/camera_models.h"
#include "camera/exposure.h"
#include "camera/lens_equation.h"

#include <gtest/gtest.h>

#include "support/random.h"

namespace obscura::test {
namespace {

Camera lens_camera(double radius_m, double focus_m) {
    Camera camera = pinhole_camera();
    camera.world_from_camera = {};
    camera.model = CameraModel::thin_lens;
    camera.thin_lens.aperture.radius_m = static_cast<float>(radius_m);
    camera.thin_lens.inverse_focus = static_cast<float>(1 / focus_m);
    return camera;
}

FilmPoint<double> film_point(double x, double y, Pcg32& random) {
    return {{x, y}, {x, y}, {random.next_float(), random.next_float()}};
}

TEST(ThinLens, AllRaysOfAFilmPointMeetOnTheSharpPlane) {
    const Camera camera = lens_camera(0.05, 4);
    Pcg32 random(1);
    for (int i = 0; i < 100; ++i) {
        const double x = random.next_float();
        const double y = random.next_float();
        const CameraRay<double> chief = generate_ray(camera, Vec2<double>{x, y});
        const Vec3d sharp = chief.direction * (4 / -chief.direction.z);
        for (int k = 0; k < 20; ++k) {
            const CameraRay<double> ray = generate_ray(camera, film_point(x, y, random));
            EXPECT_LE(std::hypot(ray.origin.x, ray.origin.y), 0.05 * 1.000001);
            EXPECT_EQ(ray.origin.z, 0);
            const Vec3d there = ray.origin + ray.direction * (4 / -ray.direction.z);
            EXPECT_LT(length(there - sharp), 1e-6);
        }
    }
}

TEST(ThinLens, RadiusZeroIsThePinholeBitForBit) {
    Camera pinhole = pinhole_camera();
    Camera lens = pinhole;
    lens.model = CameraModel::thin_lens;
    lens.thin_lens.inverse_focus = 0.3f;
    Pcg32 random(2);
    for (int i = 0; i < 1000; ++i) {
        const Vec2<float> film{random.next_float(), random.next_float()};
        const FilmPoint<float> point{film, film, {random.next_float(), random.next_float()}};
        const CameraRay<float> a = generate_ray(pinhole, point);
        const CameraRay<float> b = generate_ray(lens, point);
        EXPECT_EQ(a.origin.x, b.origin.x);
        EXPECT_EQ(a.direction.x, b.direction.x);
        EXPECT_EQ(a.direction.y, b.direction.y);
        EXPECT_EQ(a.direction.z, b.direction.z);
    }
}

/// A photograph with 50 mm, f/2, focused at 2 m: film positions of rays from a point through the
/// lens' rim, by similar triangles behind the lens.
TEST(LensEquation, TheCircleOfConfusionIsTheShadowOfTheLens) {
    const double focal = 0.05;
    const double diameter = focal / 2;
    const double film = image_distance(focal, 2);
    EXPECT_NEAR(1 / focal, 1 / 2.0 + 1 / film, 1e-12);
    for (const double z : {0.3, 0.7, 1.0, 1.5, 2.0, 2.5, 4.0, 10.0, 100.0, 1e6}) {
        const double sharp = 1 / (1 / focal - 1 / z);
        const double rim_on_film = diameter / 2 * (1 - film / sharp);
        EXPECT_NEAR(circle_of_confusion(diameter, focal, 2, z), std::abs(2 * rim_on_film), 1e-12);
    }
}

/// The rays that our camera sends out blur as the formula says, in the plane of focus.
TEST(LensEquation, RaysSpreadLikeTheCircleOfConfusion) {
    const double focal = 0.05;
    const double focus = 2;
    const double diameter = focal / 1.4;
    const Camera camera = lens_camera(diameter / 2, focus);
    for (const double z : {0.4, 1.0, 1.7, 2.4, 5.0, 50.0}) {
        Pcg32 random(3);
        double widest = 0;
        for (int k = 0; k < 4000; ++k) {
            const CameraRay<double> ray = generate_ray(camera, film_point(0.5, 0.5, random));
            const Vec3d at = ray.origin + ray.direction * (z / -ray.direction.z);
            widest = std::max(widest, 2 * std::hypot(at.x, at.y));
        }
        // On the film a length at distance z is smaller by z'_focus / z.
        const double on_film = widest * image_distance(focal, focus) / z;
        EXPECT_NEAR(on_film, circle_of_confusion(diameter, focal, focus, z), 0.002 * on_film);
    }
}

TEST(Exposure, IsThatOfTheHandbook) {
    EXPECT_NEAR(exposure_value(16, 1.0 / 125, 100), std::log2(16.0 * 16 * 125), 1e-12);
    EXPECT_NEAR(exposure_value(16, 1.0 / 125, 400), exposure_value(16, 1.0 / 125, 100) - 2, 1e-12);
    EXPECT_DOUBLE_EQ(exposure_value(1, 1, 100), 0);
    EXPECT_NEAR(exposure_scale(0), 1 / 1.2, 1e-12);
    EXPECT_NEAR(exposure_scale(15) * 1.2 * 32768, 1, 1e-12);
}

}  // namespace
}  // namespace obscura::test
