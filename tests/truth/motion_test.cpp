// tests/truth/motion_test.cpp - what moves while the shutter is open leaves the right trail.
// SPDX-License-Identifier: Apache-2.0
#include "scene/motion.h"

#include <gtest/gtest.h>

#include "support/scene_builder.h"
#include "truth/reference.h"

namespace obscura::test {
namespace {

constexpr int width = 64;
constexpr int height = 8;
constexpr float film_width_m = 64;  // a pixel is a metre wide

/// Looks down the z axis from far away: parallel rays.
Camera level_camera() {
    Camera camera;
    camera.model = CameraModel::orthographic;
    camera.orthographic.half_width_m = film_width_m / 2;
    camera.orthographic.half_height_m = film_width_m / 2 * height / width;
    camera.world_from_camera.m[2][3] = 100;
    return camera;
}

Material bright() {
    Material m;
    m.flags = material_unlit;
    return m;
}

constexpr float square_m = 4;

/// A white square whose left edge is at x.
Scene square_at(float x) {
    SceneBuilder builder;
    builder.quad({x, -50, 0}, {square_m, 0, 0}, {0, 100, 0}, builder.material(bright()));
    return builder.take();
}

/// Poses on the way of the square from x = -16 to 12: 28 m.
std::vector<Scene> poses_of(int steps, const std::function<Scene(float)>& at) {
    std::vector<Scene> poses;
    for (int s = 0; s < steps; ++s)
        poses.push_back(at(-16.0f + 28.0f * static_cast<float>(s) / static_cast<float>(steps - 1)));
    return poses;
}

Scene joined(std::vector<Scene> poses) {
    Scene first = std::move(poses.front());
    poses.erase(poses.begin());
    EXPECT_TRUE(join_motion(first, poses));
    return first;
}

/// Mean of each column of pixels.
std::vector<double> profile(Scene scene, const std::vector<Affined>& moving_camera = {}) {
    RenderOptions options;
    options.width = width;
    options.height = height;
    options.samples_per_pixel = 256;
    options.moving_camera = moving_camera;
    LightingOptions lighting;
    lighting.environment = constant_environment(0.0f);
    const Film film = render_scene(std::move(scene), lighting, level_camera(), options).film;
    std::vector<double> means(width, 0.0);
    for (size_t i = 0; i < film.pixels.size() / 4; ++i)
        means[i % width] += static_cast<double>(film.pixels[4 * i]) / height;
    return means;
}

/// How long the square covers a place, as a share of the time that the shutter is open.
double covered(double x) {
    const double begin = std::clamp((x - square_m + 16) / 28, 0.0, 1.0);
    const double end = std::clamp((x + 16) / 28, 0.0, 1.0);
    return end - begin;
}

double covered_in_column(int column) {
    double sum = 0;
    constexpr int parts = 64;
    for (int i = 0; i < parts; ++i)
        sum += covered(column - width / 2 + (i + 0.5) / parts);
    return sum / parts;
}

void expect_trail(const std::vector<double>& seen) {
    for (int column = 0; column < width; ++column) {
        EXPECT_NEAR(seen[static_cast<size_t>(column)], covered_in_column(column), 0.01) << column;
    }
}

TEST(Motion, AMovingSquareLeavesATrailOfItsLengthAndAnEvenProfile) {
    expect_trail(profile(joined(poses_of(2, square_at))));
    expect_trail(profile(joined(poses_of(5, square_at))));
}

TEST(Motion, SoDoesAMovingInstance) {
    const auto instance_at = [](float x) {
        Scene scene = square_at(0);
        scene.world_primitive_count = 0;
        scene.meshes.push_back({0, 1});
        Instance placing;
        placing.world_from_object.m[0][3] = x;
        placing.object_from_world = inverse(placing.world_from_object);
        scene.instances.push_back(placing);
        return scene;
    };
    expect_trail(profile(joined(poses_of(3, instance_at))));
}

/// A camera that moves to the left sees what a still one sees of things that move to the right.
TEST(Motion, SoDoesAMovingCamera) {
    std::vector<Affined> placings(3);
    for (size_t s = 0; s < placings.size(); ++s) {
        placings[s].m[2][3] = 100;
        placings[s].m[0][3] = -14.0 * static_cast<double>(s);
    }
    expect_trail(profile(square_at(-16), placings));
}

TEST(Motion, WhatStandsStillIsNotKept) {
    const Scene still = joined({square_at(1), square_at(1), square_at(1)});
    EXPECT_EQ(still.motion.steps, 1);
    EXPECT_TRUE(still.motion.positions.empty());
    Scene other = square_at(1);
    EXPECT_FALSE(join_motion(other, std::vector<Scene>{SceneBuilder().take()}));
    EXPECT_EQ(other.motion.steps, 1);
}

/// A white square, turned about the x axis, under a lamp that shines straight down at it: its
/// radiance is the cosine at each moment, and its mean that over the angle.
TEST(Motion, ShadingFollowsTheMovingNormal) {
    const auto turned = [](float angle) {
        SceneBuilder builder;
        Material matt;
        matt.metallic = 0;
        const Vec3f up{0, 40 * std::cos(angle), 40 * std::sin(angle)};
        builder.quad(up * -0.5f + Vec3f{-40, 0, 0}, {80, 0, 0}, up, builder.material(matt));
        Scene scene = builder.take();
        PunctualLight sun;
        sun.type = static_cast<int32_t>(PunctualType::directional);
        std::fill_n(sun.intensity, 3, static_cast<float>(pi_d));
        scene.lights.push_back(sun);
        return scene;
    };
    std::vector<Scene> poses;
    constexpr int steps = 9;
    const double last = pi_d / 3;
    for (int s = 0; s < steps; ++s)
        poses.push_back(turned(static_cast<float>(last * s / (steps - 1))));
    RenderOptions options;
    options.width = width;
    options.height = height;
    options.samples_per_pixel = 256;
    const Mean mean =
        film_mean(render_scene(joined(std::move(poses)), {}, level_camera(), options).film);
    Material matt;
    matt.metallic = 0;
    double expected = 0;
    constexpr int parts = 1000;
    for (int i = 0; i < parts; ++i) {
        const double angle = last * (i + 0.5) / parts;
        const Vec3d towards = polar_direction(std::cos(angle), 0);  // lamp and viewer are the same
        expected += pi_d * evaluate_bsdf(exact_bsdf(matt), towards, towards).value_cos.x / parts;
    }
    EXPECT_NEAR(mean.value, expected, 4 * mean.error + 0.003 * expected);
}

}  // namespace
}  // namespace obscura::test
