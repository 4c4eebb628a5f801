// tests/camera/environment_test.cpp - images of all directions against their closed forms.
// SPDX-License-Identifier: Apache-2.0
#include "camera/environment.h"

#include "camera/camera_models.h"

#include <gtest/gtest.h>

#include "support/random.h"

namespace obscura::test {
namespace {

Camera at_origin(EnvironmentProjection projection) {
    Camera camera = environment_camera(projection);
    camera.world_from_camera = {};
    return camera;
}

/// docs/conventions.md: u = atan2(z, x) / 2 pi + 0.5, v = acos(y) / pi, for a camera rotated to
/// look along +X.
TEST(Environment, LatLongIsTheConventionOfEnvironmentMaps) {
    Camera camera = at_origin(EnvironmentProjection::latlong);
    camera.world_from_camera = {{{0, 0, -1, 0}, {0, 1, 0, 0}, {1, 0, 0, 0}}};
    Pcg32 random(1);
    for (int i = 0; i < 2000; ++i) {
        const Vec2<double> film{random.next_float(), random.next_float()};
        const Vec3d d = generate_ray(camera, film).direction;
        EXPECT_NEAR((std::atan2(d.z, d.x) / (2 * pi_d) + 0.5 - film.x) * film_width, 0, 1e-4);
        EXPECT_NEAR((std::acos(d.y) / pi_d - film.y) * film_height, 0, 1e-4);
        const auto narrow = generate_ray(
            camera, Vec2<float>{static_cast<float>(film.x), static_cast<float>(film.y)});
        EXPECT_LT(length(widen(narrow.direction) - d), 1e-6);
    }
}

TEST(Environment, TheCentreLooksAheadAndRightIsRight) {
    for (const auto projection :
         {EnvironmentProjection::latlong, EnvironmentProjection::cylindrical}) {
        const Camera camera = at_origin(projection);
        EXPECT_NEAR(generate_ray(camera, Vec2<double>{0.5, 0.5}).direction.z, -1, 1e-9);
        EXPECT_NEAR(generate_ray(camera, Vec2<double>{0.75, 0.5}).direction.x, 1, 1e-9);
        EXPECT_GT(generate_ray(camera, Vec2<double>{0.5, 0.25}).direction.y, 0.3);
    }
}

TEST(Environment, ACylinderKeepsVerticalTangents) {
    const Camera camera = at_origin(EnvironmentProjection::cylindrical);
    for (const double v : {0.0, 0.2, 0.5, 0.9}) {
        const Vec3d d = generate_ray(camera, Vec2<double>{0.3, v}).direction;
        const double half_height = static_cast<double>(camera.environment.half_height);
        EXPECT_NEAR(d.y / std::hypot(d.x, d.z), (1 - 2 * v) * half_height, 1e-12);
        EXPECT_NEAR(std::atan2(d.x, -d.z), 2 * pi_d * (0.3 - 0.5), 1e-12);
    }
}

/// Axis, right and up of each face, as docs/cameras.md lists them.
struct Face {
    Vec3d axis, right, up;
};
constexpr Face faces[6] = {{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                           {{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
                           {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
                           {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
                           {{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}},
                           {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}}};

TEST(Environment, EveryFaceOfACubeIsAPinholeOfNinetyDegrees) {
    for (const int columns : {6, 3, 1}) {
        Camera camera = at_origin(EnvironmentProjection::cubemap);
        camera.environment.cube_columns = columns;
        const int rows = 6 / columns;
        Pcg32 random(2);
        for (int i = 0; i < 600; ++i) {
            const Face& face = faces[i % 6];
            EXPECT_LT(length(cross(face.axis, face.up) - face.right), 1e-12) << "not mirrored";
            const double a = 2 * static_cast<double>(random.next_float()) - 1;
            const double b = 2 * static_cast<double>(random.next_float()) - 1;
            const Vec2<double> film{(i % 6 % columns + (a + 1) / 2) / columns,
                                    (i % 6 / columns + (1 - b) / 2) / rows};
            const Vec3d wanted = normalize(face.axis + a * face.right + b * face.up);
            EXPECT_LT(length(generate_ray(camera, film).direction - wanted), 1e-12);
        }
    }
}

TEST(Environment, SamplesBeyondAnEdgeContinueTheirOwnFaceOrEye) {
    Camera cube = at_origin(EnvironmentProjection::cubemap);
    cube.environment.cube_columns = 6;
    const FilmPoint<double> over{{1.0 / 6 + 0.001, 0.5}, {1.0 / 6 - 0.001, 0.5}, {0.5, 0.5}};
    const Vec3d d = generate_ray(cube, over).direction;
    EXPECT_GT(d.x, 0.7);  // still the +X face, a little beyond its right edge
    EXPECT_GT(d.z, d.x);
    Camera eyes = at_origin(EnvironmentProjection::latlong);
    eyes.environment.half_eyes_m = 0.03f;
    const FilmPoint<double> below{{0.5, 0.5001}, {0.5, 0.499}, {0.5, 0.5}};
    EXPECT_LT(generate_ray(eyes, below).origin.x, 0);  // still the left eye
    EXPECT_LT(generate_ray(eyes, below).direction.y, -0.99);
}

/// Each eye stands beside the centre, at right angles to its view direction.
TEST(Environment, EyesStandBesideTheDirectionTheyLookIn) {
    Camera camera = at_origin(EnvironmentProjection::latlong);
    camera.environment.half_eyes_m = 0.032f;
    const double half = static_cast<double>(0.032f);
    for (const double u : {0.1, 0.5, 0.77}) {
        for (const double v : {0.2, 0.5, 0.7}) {
            const CameraRay<double> left = generate_ray(camera, Vec2<double>{u, v / 2});
            const CameraRay<double> right = generate_ray(camera, Vec2<double>{u, 0.5 + v / 2});
            EXPECT_LT(length(left.direction - right.direction), 1e-12);
            EXPECT_LT(length(left.origin + right.origin), 1e-12);
            EXPECT_NEAR(length(left.origin), half, 1e-12);
            EXPECT_NEAR(left.origin.y, 0, 1e-12);
            EXPECT_NEAR(dot(left.origin, left.direction), 0, 1e-12);
            const Vec3d to_the_right = cross(left.direction, Vec3d{0, 1, 0});
            EXPECT_GT(dot(right.origin, to_the_right), 0);
        }
    }
}

}  // namespace
}  // namespace obscura::test
