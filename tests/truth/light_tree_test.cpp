// tests/truth/light_tree_test.cpp - many lights chosen by a tree: the light of all of them arrives.
// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include "support/shape_scenes.h"
#include "truth/dielectric_scene.h"
#include <cstring>

namespace obscura::test {
namespace light_tree_truth {

Material matt() {
    Material m;
    m.metallic = 0;
    m.roughness = 1;
    std::fill_n(m.base_color, 3, 0.5f);
    return m;
}

Vec3f place_of(Pcg32& random) {
    const float x = 6 * random.next_float() - 3;
    const float y = 0.5f + random.next_float();
    return {x, y, 6 * random.next_float() - 3};
}

/// A floor under 300 points of light.
Scene points_over_floor() {
    SceneBuilder builder;
    builder.quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, builder.material(matt()));
    Scene scene = builder.take();
    Pcg32 random(1);
    for (int i = 0; i < 300; ++i) {
        PunctualLight light;
        const Vec3f place = place_of(random);
        std::copy_n(&place.x, 3, light.position);
        std::fill_n(light.intensity, 3, 0.1f + random.next_float());
        scene.lights.push_back(light);
    }
    return scene;
}

constexpr Vec3f floor_point{0.4f, 0, -0.3f};

/// Radiance of that point towards the zenith, with the lights moved along x.
double radiance_of_floor(const Scene& scene, double shift) {
    double sum = 0;
    for (const PunctualLight& light : scene.lights) {
        const Vec3d to_light{static_cast<double>(light.position[0] - floor_point.x) + shift,
                             static_cast<double>(light.position[2] - floor_point.z),
                             static_cast<double>(light.position[1])};
        // In the floor's frame the normal is z, and the camera looks along it.
        sum += evaluate_bsdf(exact_bsdf(matt()), {0, 0, 1}, normalize(to_light)).value_cos.x *
               static_cast<double>(light.intensity[0]) / dot(to_light, to_light);
    }
    return sum;
}

Mean seen_floor(const Scene& scene) {
    constexpr int side = 16;
    RenderOptions options;
    options.width = side;
    options.height = side;
    options.samples_per_pixel = 256;
    options.integrator = Integrator::direct;
    const Vec3f above{floor_point.x, 300, floor_point.z};
    const Camera camera = look_at(above, floor_point, 1e-5f, side, side);
    return film_mean(render_scene(scene, {}, camera, options).film);
}

TEST(LightTreeTruth, TheFloorHasTheLightOfAllPoints) {
    const Scene scene = points_over_floor();
    const double expected = radiance_of_floor(scene, 0);
    const Mean mean = seen_floor(scene);
    EXPECT_NEAR(mean.value / expected, 1, 5 * mean.error / expected);
    EXPECT_LT(mean.error / expected, 2e-3);
}

TEST(LightTreeTruth, TheFloorHasTheLightOfAllPointsThatMove) {
    Scene scene = points_over_floor();
    constexpr double way = 1.5;
    scene.motion.steps = 2;
    for (const PunctualLight& light : scene.lights) {
        scene.motion.lights.push_back(light);
        scene.motion.lights.push_back(light);
        scene.motion.lights.back().position[0] += static_cast<float>(way);
    }
    double expected = 0;
    constexpr int times = 400;
    for (int i = 0; i < times; ++i)
        expected += radiance_of_floor(scene, way * (i + 0.5) / times) / times;
    const Mean mean = seen_floor(scene);
    EXPECT_NEAR(mean.value / expected, 1, 5 * mean.error / expected);
    EXPECT_LT(mean.error / expected, 5e-3);
}

Material lamp_of(Pcg32& random, bool two_sided) {
    Material lamp;
    std::fill_n(lamp.emission, 3, 2.0f + 6 * random.next_float());
    if (two_sided) lamp.flags = material_double_sided;
    return lamp;
}

/// A matt and a glossy sphere among lamps of one side and of two. Beside them, if asked for, a
/// sheet that lets light through, a cube of fog that does not refract, and lamps that are spheres
/// and disks.
Scene lamps_around_spheres(bool with_shapes) {
    DielectricScene dielectrics;
    SceneBuilder& builder = dielectrics.builder;
    Material gloss = matt();
    gloss.roughness = 0.3f;
    builder.quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, builder.material(matt()));
    builder.sphere({-0.8f, 0.7f, 0}, 0.5f, 16, builder.material(gloss));
    builder.sphere({0.8f, 0.7f, 0}, 0.5f, 16, builder.material(matt()));
    Pcg32 random(2);
    for (int i = 0; i < 30; ++i) {
        const int32_t lamp = builder.material(lamp_of(random, i % 2 == 0));
        builder.quad(place_of(random), {0.3f, 0.1f, 0}, {0, 0.1f, 0.3f}, lamp);
    }
    if (!with_shapes) return builder.take();
    MaterialLayers sheet;
    sheet.diffuse_transmission = 0.7f;
    builder.quad({-0.5f, 0.2f, 1.2f}, {1, 0, 0}, {0, 0.8f, 0}, dielectrics.add(sheet));
    MaterialLayers fog = dielectric(1, {2, 2, 2});
    std::fill_n(fog.scatter_albedo, 3, 0.8f);
    dielectrics.box({-0.4f, 0.3f, -1.2f}, {0.4f, 1.1f, -0.4f}, dielectrics.add(fog));
    std::vector<int32_t> lamps;
    for (int i = 0; i < 12; ++i)
        lamps.push_back(builder.material(lamp_of(random, i % 2 == 0)));
    Scene scene = dielectrics.take();
    for (const int32_t lamp : lamps) {
        const bool round = lamp % 3 == 0;
        ShapeRecord shape = make_shape(round ? ShapeKind::sphere : ShapeKind::disk, 0.15f);
        const Vec3f place = place_of(random);
        std::copy_n(&place.x, 3, shape.centre);
        add_shape(scene, shape, lamp);
    }
    return scene;
}

LightingOptions faint_sky() {
    LightingOptions lighting;
    lighting.environment = constant_environment(0.2f);
    return lighting;
}

RenderOptions small_image() {
    RenderOptions options;
    options.width = options.height = 20;
    options.samples_per_pixel = 256;
    options.max_bounces = 2;
    return options;
}

/// BSDF sampling chooses no lights: what it finds, the tree must bring too, alone and by MIS.
void expect_strategies_agree(bool with_shapes) {
    RenderOptions options = small_image();
    if (with_shapes) options.max_bounces = 8;  // boundaries of fog count
    const Camera camera = look_at({0, 1.5f, 4}, {0, 0.6f, 0}, 0.7f, 20, 20);
    const auto measure = [&](int strategies) {
        options.strategies = strategies;
        constexpr int runs = 16;
        double sum = 0;
        double squares = 0;
        for (int run = 0; run < runs; ++run) {
            options.seed = static_cast<uint64_t>(100 * strategies + run);
            Scene scene = lamps_around_spheres(with_shapes);
            const Film film = render_scene(std::move(scene), faint_sky(), camera, options).film;
            const double v = film_mean(film).value;
            sum += v;
            squares += v * v;
        }
        const double mean = sum / runs;
        return Mean{mean, std::sqrt(std::max(0.0, squares / runs - mean * mean) / (runs - 1))};
    };
    const Mean both = measure(3);
    for (const int strategies : {1, 2}) {
        const Mean one = measure(strategies);
        const double sigma = std::sqrt(both.error * both.error + one.error * one.error);
        EXPECT_NEAR(one.value, both.value, 3.5 * sigma) << "strategy " << strategies;
        EXPECT_LT(sigma, 0.02 * both.value) << "too noisy to tell anything";
    }
}

TEST(LightTreeTruth, LightSamplingBsdfSamplingAndBothAgree) {
    expect_strategies_agree(false);
}

TEST(LightTreeTruth, TheyAgreeInFogOnSheetsAndForShapes) {
    expect_strategies_agree(true);
}

TEST(LightTreeTruth, ThreadsAndTilesDoNotChangeABit) {
    RenderOptions options = small_image();
    const Camera camera = look_at({0, 1.5f, 4}, {0, 0.6f, 0}, 0.7f, 20, 20);
    const auto pixels = [&](int threads, int tile_size) {
        const ThreadLimit limit(threads);
        options.tile_size = tile_size;
        Scene scene = lamps_around_spheres(true);
        return render_scene(std::move(scene), faint_sky(), camera, options).film.pixels;
    };
    const auto one = pixels(1, 16);
    const auto other = pixels(3, 8);
    ASSERT_EQ(one.size(), other.size());
    EXPECT_EQ(std::memcmp(one.data(), other.data(), one.size() * sizeof(float)), 0);
}

}  // namespace light_tree_truth
}  // namespace obscura::test
