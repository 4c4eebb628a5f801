// tests/truth/splats_test.cpp - rendered Gaussian splats: seen, before and behind, as shadows.
// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include "support/scene_builder.h"
#include "support/splat_scenes.h"
#include "truth/reference.h"
#include <cstring>

namespace obscura::test {
namespace splats_truth {

constexpr int side = 48;

RenderOptions options_of(Integrator integrator = Integrator::path, int samples = 16) {
    RenderOptions options;
    options.width = side;
    options.height = side;
    options.samples_per_pixel = samples;
    options.integrator = integrator;
    options.background = BackgroundKind::transparent;
    return options;
}

Camera from_front() {
    return look_at({0, 0, 10}, {0, 0, 0}, 0.5F, side, side);
}

double channel_at(const Film& film, int x, int y, size_t channel) {
    const size_t pixel = static_cast<size_t>(y) * side + static_cast<size_t>(x);
    return static_cast<double>(film.pixels[pixel * film.channels.size() + channel]);
}

/// Ray through a point of a pixel.
Vec3d direction_through(const Camera& camera, double x, double y) {
    const double tangent = static_cast<double>(camera.pinhole.tan_half_yfov);
    return normalize(Vec3d{(2 * x / side - 1) * tangent, (1 - 2 * y / side) * tangent, -1});
}

Affined stretched() {
    Affined map = ball({0.2, -0.1, 0.5}, 0.3);
    map.m[0][0] = 0.9;
    map.m[0][1] = 0.2;
    map.m[1][2] = -0.4;
    map.m[2][0] = 0.5;
    return map;
}

Material unlit(float red) {
    Material m;
    m.flags = material_unlit | material_double_sided;
    m.base_color[0] = red;
    return m;
}

Film draw(Scene scene, const RenderOptions& options) {
    return render_scene(std::move(scene), {}, from_front(), options).film;
}

/// Mean of the closed form over a pixel, by a grid.
double mean_alpha(const TestSplat& splat, int x, int y) {
    constexpr int grid = 8;
    double sum = 0;
    for (int i = 0; i < grid * grid; ++i) {
        const Vec3d d = direction_through(
            from_front(), x + (i % grid + 0.5) / grid, y + (i / grid + 0.5) / grid);
        const TruePassage at = true_passage(splat.world_from_ball, {0, 0, 10}, d);
        sum += true_alpha(static_cast<double>(splat.opacity), at.squared);
    }
    return sum / (grid * grid);
}

TEST(Splats, APixelShowsTheKernel) {
    const TestSplat splat{stretched(), 0.8F, {0.5F, 1, 2}};
    for (const Integrator integrator : {Integrator::path, Integrator::raycast}) {
        Scene scene = SceneBuilder().take();
        add_splats(scene, {splat});
        const Film film = draw(std::move(scene), options_of(integrator, 64));
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                const double alpha = mean_alpha(splat, x, y);
                EXPECT_NEAR(channel_at(film, x, y, 3), alpha, 0.006) << x << " " << y;
                EXPECT_NEAR(channel_at(film, x, y, 0), 0.5 * alpha, 0.003);
                EXPECT_NEAR(channel_at(film, x, y, 2), 2 * alpha, 0.012);
            }
        }
    }
}

TEST(Splats, LieBeforeAndBehindSurfaces) {
    const TestSplat splat{stretched(), 0.8F, {0.5F, 1, 2}};
    for (const float z : {-3.0F, 3.0F}) {
        SceneBuilder builder;
        builder.quad({-5, -5, z}, {10, 0, 0}, {0, 10, 0}, builder.material(unlit(0.25F)));
        Scene scene = builder.take();
        add_splats(scene, {splat});
        const Film film = draw(std::move(scene), options_of());
        const double alpha = z < 0 ? mean_alpha(splat, 25, 24) : 0;
        EXPECT_NEAR(channel_at(film, 25, 24, 3), 1, 1e-6);
        EXPECT_NEAR(channel_at(film, 25, 24, 0), alpha * 0.5 + (1 - alpha) * 0.25, 0.003);
        EXPECT_NEAR(channel_at(film, 2, 2, 0), 0.25, 1e-6);
    }
}

TEST(Splats, ABackgroundColourShinesThrough) {
    const TestSplat splat{ball({0, 0, 0}, 2), 0.75F, {1, 1, 1}};
    const TestSplat closed{ball({0, 0, 0}, 2), 1, {1, 1, 1}};
    for (const TestSplat& one : {splat, closed}) {
        Scene scene = SceneBuilder().take();
        add_splats(scene, {one});
        RenderOptions options = options_of();
        options.background = BackgroundKind::color;
        options.background_color[0] = 0.5F;
        const Film film = draw(std::move(scene), options);
        const double alpha = mean_alpha(one, 24, 24);
        EXPECT_NEAR(channel_at(film, 24, 24, 0), alpha + 0.5 * (1 - alpha), 0.003);
        EXPECT_NEAR(channel_at(film, 24, 24, 1), alpha, 0.003);
    }
}

/// The light of a lamp straight above, on a floor seen from the side.
double floor_radiance(const std::vector<TestSplat>& splats, Integrator integrator) {
    SceneBuilder builder;
    builder.quad({-9, 0, 9}, {18, 0, 0}, {0, 0, -18}, builder.material({}));
    Scene scene = builder.take();
    PunctualLight sun;
    sun.type = static_cast<int32_t>(PunctualType::directional);
    sun.direction[0] = 0;
    sun.direction[1] = -1;
    sun.direction[2] = 0;
    scene.lights.push_back(sun);
    if (!splats.empty()) add_splats(scene, splats);
    const Camera camera = look_at({6, 1, 0}, {0, 0, 0}, 0.01F, side, side);
    const Film film = render_scene(std::move(scene), {}, camera, options_of(integrator, 4)).film;
    return channel_at(film, side / 2, side / 2, 0);
}

TEST(Splats, CastShadows) {
    const std::vector<TestSplat> above = {{ball({0, 3, 0}, 0.3), 0.5F},
                                          {ball({0, 5, 0}, 0.3), 0.6F}};
    for (const Integrator integrator : {Integrator::path, Integrator::raycast}) {
        const double lit = floor_radiance({}, integrator);
        ASSERT_GT(lit, 0.01);
        EXPECT_NEAR(floor_radiance(above, integrator) / lit, 0.5 * 0.4, 0.002);
        EXPECT_NEAR(floor_radiance({{ball({0, -3, 0}, 0.3), 1}}, integrator) / lit, 1, 1e-6);
    }
}

TEST(Splats, AreSeenInMirrors) {
    Material mirror;
    mirror.metallic = 1;
    mirror.roughness = 0;
    SceneBuilder builder;
    builder.quad({-3, -3, 0}, {6, 0, 0}, {0, 6, 0}, builder.material(mirror));
    Scene scene = builder.take();
    add_splats(scene, {{ball({0, 0, 20}, 1), 0.5F, {3, 0, 0}}});  // behind the eye
    LightingOptions lighting;
    lighting.environment = constant_environment(1);
    const Film film = render_scene(std::move(scene), lighting, from_front(), options_of()).film;
    EXPECT_NEAR(channel_at(film, 24, 24, 0), 0.5 * 3 + 0.5, 0.05);
    EXPECT_NEAR(channel_at(film, 24, 24, 1), 0.5, 0.05);
}

UnsetArray<float> cloud_with(int threads, int tile_size) {
    const ThreadLimit limit(threads);
    SceneBuilder builder;
    builder.quad({-5, -5, -3}, {10, 0, 0}, {0, 10, 0}, builder.material({}));
    Scene scene = builder.take();
    Pcg32 random(61);
    std::vector<TestSplat> splats;
    for (int i = 0; i < 3000; ++i) {
        const auto number = [&] { return 3 * random.next_double() - 1.5; };
        splats.push_back({ball({number(), number(), number()}, 0.3),
                          0.3F,
                          {random.next_float(), random.next_float(), random.next_float()}});
    }
    add_splats(scene, splats, false);
    RenderOptions options = options_of(Integrator::path, 4);
    options.tile_size = tile_size;
    LightingOptions lighting;
    lighting.environment = constant_environment(1);
    return render_scene(std::move(scene), lighting, from_front(), options).film.pixels;
}

TEST(Splats, ThreadsAndTilesDoNotChangeABit) {
    const UnsetArray<float> reference = cloud_with(1, 16);
    for (const int threads : {2, 5}) {
        const UnsetArray<float> other = cloud_with(threads, 8 * threads);
        ASSERT_EQ(other.size(), reference.size());
        EXPECT_EQ(std::memcmp(other.data(), reference.data(), other.size() * sizeof(float)), 0);
    }
}

}  // namespace splats_truth
}  // namespace obscura::test
