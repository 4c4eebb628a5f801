// tests/truth/thin_walls_test.cpp - light through smooth thin walls counts once.
// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"

#include <gtest/gtest.h>

#include "support/shape_scenes.h"
#include "support/thin_wall_scenes.h"
#include <cstring>

namespace obscura::test {
namespace thin_walls_truth {

#ifdef OBSCURA_DEBUG
constexpr int many_samples = 64;
#else
constexpr int many_samples = 1024;
#endif

/// Mean and standard error of the mean over independent runs.
Mean repeated(const Scene& scene, ThinWallView view) {
    constexpr int runs = 8;
    double sum = 0;
    double squares = 0;
    for (int run = 0; run < runs; ++run) {
        view.seed = static_cast<uint64_t>(100 * view.strategies + run);
        const double v = floor_value(scene, view);
        sum += v;
        squares += v * v;
    }
    const double mean = sum / runs;
    return {mean, std::sqrt(std::max(0.0, squares / runs - mean * mean) / (runs - 1))};
}

/// Light sampling, BSDF sampling, and both together must find the same light. Light sampling alone
/// misses the panes' mirror images, so it is tested without bounces.
void expect_strategies_agree(const Scene& scene, ThinWallView view, double max_error) {
    view.strategies = sample_lights | sample_bsdfs;
    const Mean both = repeated(scene, view);
    EXPECT_GT(both.value, 0.001);
    for (const int strategies : {sample_bsdfs, sample_lights}) {
        if (strategies == sample_lights && view.bounces > 0) continue;
        view.strategies = strategies;
        const Mean one = repeated(scene, view);
        const double sigma = std::sqrt(both.error * both.error + one.error * one.error);
        EXPECT_NEAR(one.value, both.value, 3.5 * sigma) << "strategy " << strategies;
        EXPECT_LT(sigma, max_error * both.value) << "too noisy to tell anything";
    }
}

/// A floor under two panes, the upper one tinted.
ThinWallScene two_panes() {
    ThinWallScene scene;
    scene.pane(1, scene.add(glass_material(), glass_layers()));
    Material tinted = glass_material();
    tinted.base_color[0] = 0.6f;
    scene.pane(1.5f, scene.add(tinted, glass_layers()));
    return scene;
}

LightingOptions even_sky() {
    LightingOptions lighting;
    lighting.environment = constant_environment(1);
    return lighting;
}

/// A grey sky with a sun of one pixel, 33 degrees from the zenith.
LightingOptions sky_with_sun(float sky_radiance = 0.05f) {
    ImageRgb32f sky{128, 64, {}};
    sky.pixels.assign(128 * 64 * 3, sky_radiance);
    std::fill_n(sky.pixels.begin() + (11 * 128 + 70) * 3, 3, 400.0f);
    LightingOptions lighting;
    lighting.environment = shared(sky);
    return lighting;
}

TEST(ThinWalls, UnderAnEvenSkyTheFloorGetsTheIntegral) {
    ThinWallScene scene;
    scene.pane(1, scene.add(glass_material(), glass_layers()), 1e4f);
    const Scene built = scene.take();
    const double expected = reflected(exact_bsdf(built.materials[0]),
                                      {0, 0, 1},
                                      [](const Vec3d& wi) { return pane_lets_pass(wi.z); });
    for (const int strategies : {1, 2, 3}) {
        const ThinWallView view{
            .samples = many_samples, .strategies = strategies, .lighting = even_sky()};
        const Mean seen = film_mean(floor_film(built, view));
        EXPECT_NEAR(seen.value, expected, 4 * seen.error + 5e-4) << strategies;
    }
}

TEST(ThinWalls, SkiesAreFoundByLightSamplingAndByBouncesAlike) {
    for (const int bounces : {0, 1, 4}) {
        const ThinWallView view{.samples = many_samples / 4, .bounces = bounces};
        ThinWallView sky = view;
        sky.lighting = even_sky();
        expect_strategies_agree(two_panes().take(), sky, 0.01);
        ThinWallView sun = view;
        sun.lighting = sky_with_sun();
        expect_strategies_agree(two_panes().take(), sun, 0.2);
    }
}

/// A bounced ray's hit has the density of the whole distance since the floor.
TEST(ThinWalls, LampsAreFoundByLightSamplingAndByBouncesAlike) {
    Material lamp;
    lamp.metallic = 0;
    std::fill_n(lamp.base_color, 3, 0.0f);
    std::fill_n(lamp.emission, 3, 5.0f);
    lamp.flags = material_double_sided;
    for (const int bounces : {0, 3}) {
        const ThinWallView view{.samples = many_samples / 2, .bounces = bounces};
        ThinWallScene square = two_panes();
        square.pane(2, square.builder.material(lamp), 0.5f);
        expect_strategies_agree(square.take(), view, 0.02);
        ThinWallScene round = two_panes();
        const int32_t index = round.builder.material(lamp);
        Scene scene = round.take();
        ShapeRecord ball = make_shape(ShapeKind::sphere, 0.5f);
        add_shape(scene, ball, index, raised(2.5));
        expect_strategies_agree(scene, view, 0.02);
    }
}

/// With the sun a pixel wide, light sampling alone is nearly free of noise.
TEST(ThinWalls, ASmallSunIsAsBrightAsThePaneLetsPass) {
    const auto seen = [](bool covered) {
        ThinWallScene scene;
        if (covered) scene.pane(1, scene.add(glass_material(), glass_layers()), 1e4f);
        const LightingOptions lighting = sky_with_sun(0);
        return film_mean(floor_film(scene.take(), {.samples = many_samples, .lighting = lighting}));
    };
    const double cosine = std::cos(11.5 / 64 * pi_d);
    EXPECT_NEAR(seen(true).value / seen(false).value, pane_lets_pass(cosine), 0.002);
}

/// The camera sees the sky through a grey pane, and the same sky mirrored in it.
TEST(ThinWalls, CamerasSeeStraightThrough) {
    ThinWallScene scene;
    Material grey = glass_material();
    std::fill_n(grey.base_color, 3, 0.5f);
    scene.pane(1, scene.add(grey, glass_layers()), 1e4f);
    RenderOptions options;
    options.width = options.height = thin_wall_image_size;
    options.samples_per_pixel = many_samples;
    options.max_bounces = 0;
    const Camera up =
        look_at({0, 0.5f, 0}, {0.6f, 1.3f, 0}, 1e-4f, thin_wall_image_size, thin_wall_image_size);
    const Mean seen = film_mean(render_scene(scene.take(), even_sky(), up, options).film);
    const double expected = 1 - 0.5 * pane_lets_pass(0.8);
    EXPECT_NEAR(seen.value, expected, 4 * seen.error + 1e-3);
}

/// A white floor within a colourless bulb, under an even sky: everything comes back.
TEST(ThinWalls, NothingIsLostInABulb) {
    ThinWallScene scene;
    scene.builder.sphere({0, 0, 0}, 4, 24, scene.add(glass_material(), glass_layers()));
    const ThinWallView view{.samples = many_samples, .bounces = 64, .lighting = even_sky()};
    const Mean seen = film_mean(floor_film(scene.take(), view));
    EXPECT_NEAR(seen.value, 1, 4 * seen.error + 4e-3);
}

UnsetArray<float> pixels_with(int threads, int tile_size) {
    const ThreadLimit limit(threads);
    ThinWallScene scene = two_panes();
    scene.light(lamp_at({1, 4, 1}));
    RenderOptions options;
    options.width = 50;
    options.height = 40;
    options.samples_per_pixel = 16;
    options.tile_size = tile_size;
    const Camera camera = look_at({0, 3, 3}, {0, 0.5f, 0}, 1.0f, 50, 40);
    return render_scene(scene.take(), sky_with_sun(), camera, options).film.pixels;
}

TEST(ThinWalls, ThreadsAndTilesDoNotChangeABit) {
    const UnsetArray<float> reference = pixels_with(1, 16);
    for (const int tile_size : {8, 32}) {
        const UnsetArray<float> other = pixels_with(3, tile_size);
        ASSERT_EQ(other.size(), reference.size());
        EXPECT_EQ(std::memcmp(other.data(), reference.data(), other.size() * sizeof(float)), 0);
    }
}

}  // namespace thin_walls_truth
}  // namespace obscura::test
