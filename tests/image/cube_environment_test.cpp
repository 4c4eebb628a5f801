// tests/image/cube_environment_test.cpp - cube maps against known functions of direction.
// SPDX-License-Identifier: Apache-2.0
#include "image/cube_environment.h"

#include "light/environment_table.h"
#include "surface/srgb.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace obscura {
namespace {

constexpr Affined unturned = {};

/// Fills the texels by the direction of their centres.
template <typename Radiance>
CubeFaces cube_of(int side, const Radiance& radiance) {
    CubeFaces faces;
    for (size_t face = 0; face < faces.size(); ++face) {
        faces[face] = {side, side, {}};
        const CubeFaceFrame frame = cube_face_frame(face);
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                const double s = (2 * x + 1.0) / side - 1;
                const double t = (2 * y + 1.0) / side - 1;
                const Vec3d d = normalize(frame.middle + frame.right * s + frame.down * t);
                const Vec3d value = radiance(d);
                for (const double part : {value.x, value.y, value.z})
                    faces[face].pixels.push_back(static_cast<float>(part));
            }
        }
    }
    return faces;
}

EnvironmentTable table_of(const CubeFaces& faces, const Affined& cube_from_world = unturned) {
    const Result<ImageRgb32f> map = environment_from_cube(faces, cube_from_world, "cube");
    EXPECT_TRUE(map);
    return *EnvironmentTable::create({map->width, map->height, map->pixels.data()}, 1, 0);
}

Vec3d seen(const EnvironmentTable& table, const Vec3d& direction) {
    return environment_radiance<double>(table.view(), normalize(direction));
}

const Vec3d directions[] = {{1, 0, 0},
                            {-1, 0, 0},
                            {0, 1, 0},
                            {0, -1, 0},
                            {0, 0, 1},
                            {0, 0, -1},
                            {1, 0.98, 0.2},
                            {-0.99, 1, -0.98},
                            {0.3, -0.8, 0.77},
                            {0.2, 0.5, -0.9},
                            {-1, -1, 1},
                            {-0.6, 0.1, 0.58}};

Vec3d smooth(const Vec3d& d) {
    return {2 + d.x, 1.5 + d.y * d.z, 3 + d.z - d.x * d.x};
}

TEST(CubeEnvironment, KnownDirectionsComeBack) {
    const EnvironmentTable table = table_of(cube_of(64, smooth));
    for (const Vec3d& d : directions) {
        const Vec3d expected = smooth(normalize(d));
        const Vec3d found = seen(table, d);
        // Straight up and down, a latitude-longitude map is half a pixel off.
        const double tolerance = d.x == 0 && d.z == 0 ? pi_d / 128 : 2e-3;
        EXPECT_NEAR(found.x, expected.x, tolerance) << d.x << " " << d.y << " " << d.z;
        EXPECT_NEAR(found.y, expected.y, tolerance) << d.x << " " << d.y << " " << d.z;
        EXPECT_NEAR(found.z, expected.z, tolerance) << d.x << " " << d.y << " " << d.z;
    }
}

/// The view of an eye along an axis in the world of glTF: right-handed, +Y up.
TEST(CubeEnvironment, FacesAreWhatTheEyeSees) {
    const struct {
        Vec3d ahead, up;
    } eyes[] = {{{1, 0, 0}, {0, 1, 0}},
                {{-1, 0, 0}, {0, 1, 0}},
                {{0, 1, 0}, {0, 0, -1}},
                {{0, -1, 0}, {0, 0, 1}},
                {{0, 0, 1}, {0, 1, 0}},
                {{0, 0, -1}, {0, 1, 0}}};
    for (size_t face = 0; face < 6; ++face) {
        // The upper right quarter of one face glows.
        CubeFaces faces = cube_of(8, [](const Vec3d&) { return Vec3d{0, 0, 0}; });
        for (size_t y = 0; y < 4; ++y)
            std::fill_n(&faces[face].pixels[3 * (8 * y + 4)], 12, 1.0F);
        const EnvironmentTable table = table_of(faces);
        const Vec3d right = cross(eyes[face].ahead, eyes[face].up);
        for (const double across : {-0.5, 0.5}) {
            for (const double up : {-0.5, 0.5}) {
                const Vec3d d = eyes[face].ahead + right * across + eyes[face].up * up;
                const double expected = across > 0 && up > 0 ? 1 : 0;
                EXPECT_NEAR(seen(table, d).x, expected, 1e-6) << face << " " << across << " " << up;
            }
        }
    }
}

TEST(CubeEnvironment, TotalFluxIsKept) {
    // The integrals of `smooth`: x, y z and z vanish, x^2 has the mean 1/3.
    const Result<ImageRgb32f> map = environment_from_cube(cube_of(32, smooth), unturned, "cube");
    ASSERT_TRUE(map);
    const double expected[] = {8 * pi_d, 6 * pi_d, 4 * pi_d * (3 - 1.0 / 3)};
    for (size_t channel = 0; channel < 3; ++channel) {
        double flux = 0;
        for (int y = 0; y < map->height; ++y) {
            const double angle =
                2 * pi_d / map->width *
                (std::cos(pi_d * y / map->height) - std::cos(pi_d * (y + 1) / map->height));
            for (int x = 0; x < map->width; ++x) {
                const auto pixel = static_cast<size_t>(y) * static_cast<size_t>(map->width) +
                                   static_cast<size_t>(x);
                flux += angle * static_cast<double>(map->pixels[3 * pixel + channel]);
            }
        }
        EXPECT_NEAR(flux / expected[channel], 1, 1e-3);
    }
}

/// A sun of one texel, in the middle of a face, at its edge and in its corner.
TEST(CubeEnvironment, OneTexelKeepsItsFlux) {
    constexpr int side = 64;
    for (const int x : {31, 63}) {
        for (const int y : {20, 0}) {
            CubeFaces faces = cube_of(side, [](const Vec3d&) { return Vec3d{0, 0, 0}; });
            faces[4].pixels[3 * (side * static_cast<size_t>(y) + static_cast<size_t>(x))] = 1000;
            const EnvironmentTable table = table_of(faces);
            const double s = (2 * x + 1.0) / side - 1;
            const double t = (2 * y + 1.0) / side - 1;
            const double steradians = 4.0 / (side * side) / std::pow(1 + s * s + t * t, 1.5);
            const double expected = 0.2126 * 1000 * steradians;
            // A corner's texel is bounded by two others, not three.
            const double tolerance = x == 63 && y == 0 ? 0.3 : x == 63 || y == 0 ? 0.04 : 0.01;
            EXPECT_NEAR(table.power() / expected, 1, tolerance) << x << " " << y;
        }
    }
}

TEST(CubeEnvironment, IsTurned) {
    // A quarter turn about +Y takes +Z to +X: what the cube has at +Z is then seen at +X.
    Affined cube_from_world;
    cube_from_world.m[0][0] = cube_from_world.m[2][2] = 0;
    cube_from_world.m[0][2] = -1;
    cube_from_world.m[2][0] = 1;
    const EnvironmentTable table = table_of(cube_of(32, smooth), cube_from_world);
    EXPECT_NEAR(seen(table, {1, 0, 0}).z, smooth({0, 0, 1}).z, 3e-3);
    EXPECT_NEAR(seen(table, {0, 0, 1}).x, smooth({-1, 0, 0}).x, 3e-3);
}

TEST(CubeEnvironment, SameBitsOnEveryRun) {
    const CubeFaces faces = cube_of(16, smooth);
    EXPECT_EQ(environment_from_cube(faces, unturned, "cube")->pixels,
              environment_from_cube(faces, unturned, "cube")->pixels);
}

TEST(CubeEnvironment, RefusesOtherThanSixEqualSquares) {
    CubeFaces faces = cube_of(4, smooth);
    faces[3] = {4, 3, std::vector<float>(36)};
    EXPECT_EQ(environment_from_cube(faces, unturned, "cube").error().id, "E-ENV-FACES");
    faces = cube_of(4, smooth);
    faces[5] = {8, 8, std::vector<float>(192)};
    EXPECT_EQ(environment_from_cube(faces, unturned, "cube").error().id, "E-ENV-FACES");
    faces = CubeFaces();
    EXPECT_EQ(environment_from_cube(faces, unturned, "cube").error().id, "E-ENV-FACES");
    for (ImageRgb32f& face : faces)
        face.width = face.height = 4097;
    EXPECT_EQ(environment_from_cube(faces, unturned, "cube").error().id, "E-ENV-LIMIT");
}

TEST(CubeEnvironment, AlphaOfAPngDivides) {
    const auto texel = [](uint32_t r, uint32_t g, uint32_t b, uint32_t a) {
        return r | g << 8 | b << 16 | a << 24;
    };
    ImageRgba8 image{2, 2, {}, "png"};
    image.texels = {texel(255, 128, 0, 255),
                    texel(255, 128, 0, 51),
                    texel(255, 128, 0, 1),
                    texel(255, 128, 0, 0)};
    const float grey = linear_from_srgb(128.0F / 255.0F);
    ImageRgb32f light = light_from_image(image);
    const float factors[] = {1, 5, 255, 255};
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_FLOAT_EQ(light.pixels[3 * i], factors[i]);
        EXPECT_FLOAT_EQ(light.pixels[3 * i + 1], factors[i] * grey);
        EXPECT_EQ(light.pixels[3 * i + 2], 0);
    }
    image.format = "jpeg";
    light = light_from_image(image);
    EXPECT_FLOAT_EQ(light.pixels[9], 1);
}

}  // namespace
}  // namespace obscura
