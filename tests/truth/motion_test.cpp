// tests/truth/motion_test.cpp - motion while the shutter is open leaves the right blur.
// SPDX-License-Identifier: Apache-2.0
#include "scene/motion.h"

#include "render/light_table.h"

#include <gtest/gtest.h>

#include "support/points_lines_scenes.h"
#include "support/scene_builder.h"
#include "truth/reference.h"

namespace obscura::test {
namespace motion_truth {

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

/// Poses of the square on its path from x = -16 to 12: 28 m.
std::vector<Scene> poses_of(int steps, const std::function<Scene(float)>& at) {
    std::vector<Scene> poses;
    for (int s = 0; s < steps; ++s)
        poses.push_back(at(-16.0f + 28.0f * static_cast<float>(s) / static_cast<float>(steps - 1)));
    return poses;
}

Scene joined(std::vector<Scene> scenes) {
    Scene first = std::move(scenes.front());
    std::vector<ScenePose> later;
    for (size_t i = 1; i < scenes.size(); ++i)
        later.push_back(take_pose(scenes[i], {}));
    EXPECT_TRUE(join_motion(first, later));
    return first;
}

LightingOptions dark() {
    LightingOptions lighting;
    lighting.environment = constant_environment(0.0f);
    return lighting;
}

/// Mean of each column of pixels.
std::vector<double> profile(Scene scene, const std::vector<Affined>& moving_camera = {}) {
    RenderOptions options;
    options.width = width;
    options.height = height;
    options.samples_per_pixel = 256;
    options.moving_camera = moving_camera;
    const Film film = render_scene(std::move(scene), dark(), level_camera(), options).film;
    std::vector<double> means(width, 0.0);
    for (size_t i = 0; i < film.pixels.size() / 4; ++i)
        means[i % width] += static_cast<double>(film.pixels[4 * i]) / height;
    return means;
}

/// Fraction of the open shutter's time in which the square covers a point.
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

/// Moves a scene's only geometry into a mesh that one instance places at x.
void place_at(float x, Scene& scene) {
    scene.meshes.push_back({0, scene.world_primitive_count});
    scene.world_primitive_count = 0;
    Instance placing;
    placing.world_from_object.m[0][3] = x;
    placing.object_from_world = inverse(placing.world_from_object);
    scene.instances.push_back(placing);
}

/// The fraction of a column's height covered by a disk or ball whose chord is seen end on.
double covered_by_disk(double x, double radius) {
    return std::abs(x) < radius ? 2 * std::sqrt(radius * radius - x * x) / height : 0;
}

/// A column's mean while a disk of that radius moves past it, 28 m from x = -16.
double trail_of_disk(int column, double radius) {
    double sum = 0;
    constexpr int parts = 400;
    for (int i = 0; i < parts; ++i) {
        const double x = -16 + 28 * (i + 0.5) / parts;
        for (int k = 0; k < 16; ++k)
            sum += covered_by_disk(column - width / 2 + (k + 0.5) / 16 - x, radius) / 16;
    }
    return sum / parts;
}

void expect_trail_of_disk(const std::vector<double>& seen, double radius) {
    for (int column = 0; column < width; ++column) {
        EXPECT_NEAR(seen[static_cast<size_t>(column)], trail_of_disk(column, radius), 0.01)
            << column;
    }
}

constexpr float ball_m = 2;

/// Points, particles and shapes move as instances; the camera sees a ball as a disk.
TEST(Motion, SoDoMovingPointsParticlesAndShapes) {
    const auto empty = [] {
        SceneBuilder builder;
        builder.material(bright());
        return builder.take();
    };
    const auto point_at = [&](float x) {
        Scene scene = empty();
        add_points(scene, {{{0, 0, 0}}}, ball_m);
        place_at(x, scene);
        return scene;
    };
    const auto particle_at = [&](float x) {
        Scene scene = empty();
        add_spheres(scene, {0, 0, 0, ball_m}, 0);
        place_at(x, scene);
        return scene;
    };
    const auto shape_at = [&](float x) {
        Scene scene = empty();
        add_shape(scene, make_shape(ShapeKind::sphere, ball_m), 0);
        place_at(x, scene);
        return scene;
    };
    expect_trail_of_disk(profile(joined(poses_of(3, point_at))), double{ball_m});
    expect_trail_of_disk(profile(joined(poses_of(3, particle_at))), double{ball_m});
    expect_trail_of_disk(profile(joined(poses_of(2, shape_at))), double{ball_m});
}

/// An upright line that crosses the whole image is a square of its diameter's width.
TEST(Motion, SoDoesAMovingLine) {
    const auto line_at = [](float x) {
        SceneBuilder builder;
        builder.material(bright());
        Scene scene = builder.take();
        add_strip(scene, {{{square_m / 2, -50, 0}}, {{square_m / 2, 50, 0}}}, square_m / 2);
        place_at(x, scene);
        return scene;
    };
    expect_trail(profile(joined(poses_of(3, line_at))));
}

/// A camera that moves to the left sees a still scene as a still one sees a scene moving right.
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
    Scene empty = SceneBuilder().take();
    EXPECT_FALSE(join_motion(other, std::vector<ScenePose>{take_pose(empty, {})}));
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

/// A matt floor that faces the camera, and a lamp 2 m above it, from x = -16 to x = 12.
Scene lamp_at(float x) {
    SceneBuilder builder;
    Material matt;
    matt.metallic = 0;
    builder.quad({-60, -60, 0}, {120, 0, 0}, {0, 120, 0}, builder.material(matt));
    Scene scene = builder.take();
    PunctualLight lamp;
    lamp.position[0] = x;
    lamp.position[2] = 2;
    std::fill_n(lamp.intensity, 3, 10.0f);
    scene.lights.push_back(lamp);
    return scene;
}

TEST(Motion, AMovingLampLightsFromWhereItIs) {
    const std::vector<double> seen = profile(joined(poses_of(3, lamp_at)));
    Material matt;
    matt.metallic = 0;
    const BsdfParams<double> bsdf = exact_bsdf(matt);
    const auto radiance = [&](double along, double across) {
        const Vec3d to_lamp{along, across, 2};
        const double squared = dot(to_lamp, to_lamp);
        const Vec3d towards = to_lamp * (1 / std::sqrt(squared));
        return evaluate_bsdf(bsdf, {0, 0, 1}, towards).value_cos.x * 10 / squared;
    };
    for (int column = 0; column < width; column += 3) {
        double expected = 0;
        constexpr int parts = 2000;
        for (int i = 0; i < parts; ++i) {
            const double x = -16 + 28 * (i + 0.5) / parts;
            const double u = (i * 0.618034) - std::floor(i * 0.618034);
            const double v = (i * 0.754878) - std::floor(i * 0.754878);
            expected += radiance(x - (column - width / 2 + u), height * (v - 0.5)) / parts;
        }
        EXPECT_NEAR(seen[static_cast<size_t>(column)], expected, 0.05 * expected) << column;
    }
}

/// A glowing square above a matt floor that moves as an instance, or vertex by vertex.
Scene tile_at(float x, bool instanced) {
    SceneBuilder builder;
    Material matt;
    matt.metallic = 0;
    Material lamp;
    std::fill_n(lamp.emission, 3, 20.0f);
    const int32_t floor = builder.material(matt);
    builder.quad({-60, -60, 0}, {120, 0, 0}, {0, 120, 0}, floor);
    const float left = instanced ? 0 : x;
    builder.quad({left, 1, 3}, {0, -2, 0}, {2, 0, 0}, builder.material(lamp));  // shines down
    Scene scene = builder.take();
    if (!instanced) return scene;
    place_at(x, scene);
    scene.world_primitive_count = 1;
    scene.meshes[0] = {1, 1};
    return scene;
}

/// With the help of light sampling the image is the same as without, with less noise.
TEST(Motion, MovingEmittersAreSampledWhereTheyAre) {
    for (const bool instanced : {true, false}) {
        const auto scene = [&] {
            return joined(poses_of(3, [&](float x) { return tile_at(x, instanced); }));
        };
        const LightTable table = [&] {
            Scene one = scene();
            return make_light_table(one, nullptr);
        }();
        ASSERT_EQ(table.triangles.size(), 2U);
        EXPECT_EQ(table.moving_triangles.size(), 6U);
        RenderOptions options;
        options.width = width;
        options.height = height;
        options.samples_per_pixel = 1024;
        options.max_bounces = 1;
        const auto mean = [&](int strategies) {
            RenderOptions own = options;
            own.strategies = strategies;
            return film_mean(render_scene(scene(), dark(), level_camera(), own).film);
        };
        const Mean both = mean(3);
        const Mean rays = mean(2);
        EXPECT_NEAR(both.value, rays.value, 0.01 * rays.value) << instanced;
    }
}

}  // namespace motion_truth
}  // namespace obscura::test
