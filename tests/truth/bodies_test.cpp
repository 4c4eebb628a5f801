// tests/truth/bodies_test.cpp - light through bodies: absorption, nesting, dispersion.
// SPDX-License-Identifier: Apache-2.0
#include "scene/media.h"

#include <gtest/gtest.h>

#include "support/scene_builder.h"
#include "truth/reference.h"

namespace obscura::test {
namespace {

constexpr int picture_size = 16;

/// Clear, smooth, colourless but for what its inside absorbs.
MaterialLayers body(float ior, const Vec3f& absorption) {
    MaterialLayers layers;
    layers.ior = ior;
    layers.transmission = 1;
    layers.medium = 1;
    layers.absorption[0] = absorption.x;
    layers.absorption[1] = absorption.y;
    layers.absorption[2] = absorption.z;
    return layers;
}

/// A scene whose materials have layers: row i of both.
class BodyScene {
public:
    int32_t add(const MaterialLayers& layers) {
        Material m;
        m.metallic = 0;
        m.roughness = 0;
        m.flags = material_double_sided;
        m.layers = static_cast<int32_t>(layers_.size());
        layers_.push_back(layers);
        return builder.material(m);
    }
    /// An axis-aligned box, fronts outside.
    void box(const Vec3f& low, const Vec3f& high, int32_t row) {
        const Vec3f d = high - low;
        const Vec3f x{d.x, 0, 0};
        const Vec3f y{0, d.y, 0};
        const Vec3f z{0, 0, d.z};
        builder.quad(low, z, y, row);
        builder.quad(low + x, y, z, row);
        builder.quad(low, x, z, row);
        builder.quad(low + y, z, x, row);
        builder.quad(low, y, x, row);
        builder.quad(low + z, x, y, row);
    }
    Scene take() {
        Scene scene = builder.take();
        scene.layers = layers_;
        number_media(scene);
        return scene;
    }

    SceneBuilder builder;

private:
    std::vector<MaterialLayers> layers_;
};

/// Straight down the z axis, under a white sky.
Vec3d seen_from_front(Scene scene) {
    RenderOptions options;
    options.width = options.height = picture_size;
    options.samples_per_pixel = 256;
    options.max_bounces = 32;
    LightingOptions lighting;
    lighting.environment = constant_environment(1.0f);
    const Camera camera = look_at({0, 0, 1000}, {0, 0, 0}, 1e-5f, picture_size, picture_size);
    const auto film = render_scene(std::move(scene), lighting, camera, options).film;
    return {film_mean(film, 0).value, film_mean(film, 1).value, film_mean(film, 2).value};
}

/// What a slab at normal incidence shows of a white sky on both sides: reflections inside it add
/// up, and only what passes is absorbed.
double slab(double ior, double sigma, double thickness) {
    const double r = square((ior - 1) / (ior + 1));
    const double t = std::exp(-sigma * thickness);
    const double passed = square(1 - r) * t / (1 - r * r * t * t);
    const double returned = r + square(1 - r) * r * t * t / (1 - r * r * t * t);
    return passed + returned;
}

TEST(Bodies, SlabsAbsorbByTheirThickness) {
    for (const float ior : {1.0f, 1.5f, 2.4f}) {
        for (const float thickness : {0.1f, 0.5f, 2.0f}) {
            BodyScene scene;
            const int32_t row = scene.add(body(ior, {0.0f, 0.7f, 3.0f}));
            scene.box({-9, -9, -thickness}, {9, 9, 0}, row);
            const Vec3d seen = seen_from_front(scene.take());
            const auto d = static_cast<double>(thickness);
            const auto n = static_cast<double>(ior);
            EXPECT_NEAR(seen.x, 1, 0.005) << ior << ", " << thickness;
            EXPECT_NEAR(seen.y, slab(n, 0.7, d), 0.006) << ior << ", " << thickness;
            EXPECT_NEAR(seen.z, slab(n, 3, d), 0.006) << ior << ", " << thickness;
        }
    }
}

/// Along the axis a ray goes through the centre, whatever the index.
TEST(Bodies, SpheresAbsorbAlongTheDiameter) {
    BodyScene scene;
    const int32_t row = scene.add(body(1.2f, {0.5f, 0.5f, 0.5f}));
    scene.builder.sphere({0, 0, 0}, 1, 64, row);
    EXPECT_NEAR(seen_from_front(scene.take()).x, slab(1.2, 0.5, 2), 0.006);
}

/// A liquid that reaches into its glass ends where the glass begins: as without the overlap.
TEST(Bodies, TheDenserOfTwoOverlappingBodiesFillsThePlace) {
    const auto filled = [](float overlap) {
        BodyScene scene;
        const int32_t glass = scene.add(body(1.5f, {0.3f, 0.0f, 0.0f}));
        const int32_t liquid = scene.add(body(1.33f, {0.0f, 0.4f, 0.0f}));
        scene.box({-9, -9, -1}, {9, 9, 0}, glass);
        scene.box({-8, -8, -3}, {8, 8, -1 + overlap}, liquid);
        return seen_from_front(scene.take());
    };
    const Vec3d overlapping = filled(0.4f);
    // 1 m of glass and 2 m of liquid, whatever lies inside the glass.
    EXPECT_NEAR(overlapping.y, std::exp(-0.8), 0.06);
    const Vec3d deeper = filled(0.8f);
    EXPECT_NEAR(overlapping.x, deeper.x, 0.004);
    EXPECT_NEAR(overlapping.y, deeper.y, 0.004);
}

TEST(Bodies, ACameraInsideSeesThroughTheWall) {
    BodyScene scene;
    const int32_t row = scene.add(body(1.5f, {0.0f, 0.0f, 0.0f}));
    scene.box({-9, -9, -2000}, {9, 9, 2000}, row);
    EXPECT_NEAR(seen_from_front(scene.take()).x, 1, 0.005);
}

TEST(Bodies, DispersionHasNoColourWhereNothingBends) {
    BodyScene scene;
    MaterialLayers flint = body(1.6f, {0.0f, 0.0f, 0.0f});
    flint.dispersion = 1;
    scene.box({-9, -9, -1}, {9, 9, 0}, scene.add(flint));
    const Vec3d seen = seen_from_front(scene.take());
    EXPECT_NEAR(seen.x, 1, 0.02);
    EXPECT_NEAR(seen.y, 1, 0.02);
    EXPECT_NEAR(seen.z, 1, 0.02);
}

}  // namespace
}  // namespace obscura::test
