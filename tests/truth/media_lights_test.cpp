// tests/truth/media_lights_test.cpp - light sampling in, through and behind media like air.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/shape_scenes.h"
#include "support/thin_wall_scenes.h"
#include "truth/dielectric_scene.h"
#include <functional>

namespace obscura::test {
namespace media_lights_truth {

/// Single scattering albedo with which light that scatters twice does not count.
constexpr float faint = 1e-3f;

MaterialLayers fog(const Vec3f& extinction, float albedo, float anisotropy = 0) {
    MaterialLayers layers = dielectric(1.0f, extinction);
    std::fill_n(layers.scatter_albedo, 3, albedo);
    layers.scatter_anisotropy = anisotropy;
    return layers;
}

/// A cube of fog around the origin, from -1 to 1.
Scene cube_of(const MaterialLayers& layers, const std::vector<PunctualLight>& lights) {
    DielectricScene dielectrics;
    const int32_t index = dielectrics.add(layers);
    Scene scene = dielectrics.take();
    scene.lights = lights;
    add_shape(scene, make_shape(ShapeKind::box, 1, 1, 1), index);
    return scene;
}

struct FrontView {
    int samples = 256;
    int strategies = sample_lights | sample_bsdfs;
    uint64_t seed = 0;
    LightingOptions lighting = {};
};

/// Straight down the z axis.
Film film_from_front(Scene scene, const FrontView& view) {
    RenderOptions options;
    options.width = options.height = image_size;
    options.samples_per_pixel = view.samples;
    options.max_bounces = 16;
    options.strategies = view.strategies;
    options.seed = view.seed;
    const Camera camera = look_at({0, 0, 1000}, {0, 0, 0}, 1e-5f, image_size, image_size);
    return render_scene(std::move(scene), view.lighting, camera, options).film;
}

/// Light at a point: the way to it, how far that is, and its radiance integrated over directions.
struct Arriving {
    Vec3d direction;
    double distance;
    double irradiance;
};

double distance_out_of_cube(const Vec3d& p, const Vec3d& d) {
    const auto axis = [](double at, double along) {
        return along == 0 ? 1e30 : ((along > 0 ? 1 : -1) - at) / along;
    };
    return std::min({axis(p.x, d.x), axis(p.y, d.y), axis(p.z, d.z)});
}

/// Radiance that the cube scatters once towards an eye on the z axis: a quadrature.
double scattered_once(double extinction,
                      double g,
                      const std::function<Arriving(const Vec3d&)>& light) {
    constexpr int steps = 20000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double z = 1 - 2 * (i + 0.5) / steps;
        const Arriving at = light({0, 0, z});
        const double way = std::min(at.distance, distance_out_of_cube({0, 0, z}, at.direction));
        const double phase =
            (1 - g * g) / (4 * pi_d) / std::pow(1 + g * g + 2 * g * at.direction.z, 1.5);
        sum += std::exp(-extinction * (1 - z + way)) * phase * at.irradiance;
    }
    return sum * extinction * static_cast<double>(faint) * 2 / steps;
}

void expect_scattered_once(const PunctualLight& lamp,
                           float g,
                           const std::function<Arriving(const Vec3d&)>& light) {
    SCOPED_TRACE(g);
    const Vec3f extinction{0.3f, 1.0f, 3.0f};
    const Film film =
        film_from_front(cube_of(fog(extinction, faint, g), {lamp}), {.samples = 1024});
    const double exact[] = {0.3, 1.0, 3.0};
    for (size_t c = 0; c < 3; ++c) {
        const double expected = scattered_once(exact[c], static_cast<double>(g), light);
        const Mean seen = film_mean(film, c);
        EXPECT_NEAR(seen.value, expected, 4 * seen.error + 3e-3 * expected) << c;
        EXPECT_LT(seen.error, 0.02 * expected);
    }
}

TEST(MediaLights, PointLightsScatterOnceAsTheQuadratureSays) {
    for (const Vec3f& place : {Vec3f{3, 1, 0.5f}, Vec3f{0.4f, 0.1f, -0.2f}}) {
        const Vec3d to{static_cast<double>(place.x),
                       static_cast<double>(place.y),
                       static_cast<double>(place.z)};
        const auto light = [&](const Vec3d& from) {
            const Vec3d way = to - from;
            const double d = length(way);
            return Arriving{way * (1 / d), d, 10 / (d * d)};
        };
        for (const float g : {-0.4f, 0.0f, 0.6f})
            expect_scattered_once(lamp_at(place), g, light);
    }
}

/// The glow around a lamp in thin fog, through which most rays pass.
TEST(MediaLights, APointLightInThinFogHasLittleNoise) {
    const Vec3d place{0.05, 0.02, -0.2};
    const PunctualLight lamp = lamp_at({0.05f, 0.02f, -0.2f});
    const Film film = film_from_front(cube_of(fog({0.05f, 0.05f, 0.05f}, faint), {lamp}), {});
    const double expected = scattered_once(0.05, 0, [&](const Vec3d& from) {
        const Vec3d way = place - from;
        const double d = length(way);
        return Arriving{way * (1 / d), d, 10 / (d * d)};
    });
    const Mean seen = film_mean(film);
    EXPECT_NEAR(seen.value, expected, 3e-3 * expected);
    EXPECT_LT(seen.error, 6e-3 * expected);
}

/// So many that a tree chooses them.
TEST(MediaLights, ManyPointLightsScatterOnceAsTheQuadratureSays) {
    std::vector<PunctualLight> lamps;
    std::vector<Vec3d> places;
    for (int i = 0; i < 40; ++i) {
        const double turn = 2.4 * i;
        const double height = 1.8 * (i + 0.5) / 40 - 0.9;
        places.push_back({0.7 * std::cos(turn), 0.7 * std::sin(turn), height});
        const Vec3d& p = places.back();
        lamps.push_back(
            lamp_at({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)}));
    }
    constexpr float g = 0.4f;
    double expected = 0;
    for (const Vec3d& place : places) {
        expected += scattered_once(1, static_cast<double>(g), [&](const Vec3d& from) {
            const Vec3d way = place - from;
            const double d = length(way);
            return Arriving{way * (1 / d), d, 10 / (d * d)};
        });
    }
    const Film film = film_from_front(cube_of(fog({1, 1, 1}, faint, g), lamps), {.samples = 1024});
    const Mean seen = film_mean(film);
    EXPECT_NEAR(seen.value, expected, 4 * seen.error + 3e-3 * expected);
    EXPECT_LT(seen.error, 0.01 * expected);
}

TEST(MediaLights, ASunScattersOnceAsTheQuadratureSays) {
    const auto light = [](const Vec3d&) { return Arriving{{0.6, 0.8, 0}, 1e30, 10}; };
    expect_scattered_once(slanting_sun(), 0.3f, light);
}

/// A floor below, or in, slabs that absorb.
double lit_through(const std::vector<float>& heights,
                   const PunctualLight& light,
                   const Vec3f& extinction,
                   size_t channel) {
    ThinWallScene floor;
    floor.light(light);
    const int32_t index = floor.add(glass_material(), fog(extinction, 0));
    Scene scene = floor.take();
    number_media(scene);
    for (const float height : heights) {
        const double h = static_cast<double>(height);
        add_shape(scene, make_shape(ShapeKind::box, 40, 0.5f, 40), index, raised(h));
    }
    return floor_value(std::move(scene), {}, channel);
}

TEST(MediaLights, ShadowsOfSlabsAreAsDarkAsTheyAbsorb) {
    const Vec3f extinction{0.2f, 0.8f, 0.0f};
    for (const PunctualLight& light : {slanting_sun(), lamp_at({6, 8, 0})}) {
        const double open = lit_through({}, light, extinction, 0);
        ASSERT_GT(open, 0.01);
        const double way = 1 / 0.8;
        for (const size_t channel : {0U, 1U, 2U}) {
            const double sigma = std::array{0.2, 0.8, 0.0}[channel];
            EXPECT_NEAR(lit_through({2.5f}, light, extinction, channel) / open,
                        std::exp(-sigma * way),
                        1e-4);
            EXPECT_NEAR(lit_through({2.5f, 4.5f}, light, extinction, channel) / open,
                        std::exp(-2 * sigma * way),
                        1e-4);
        }
    }
}

/// The lamp is inside the second slab, or the floor and the eye are.
TEST(MediaLights, LightsAndFloorsInsideAreAttenuatedUpToThere) {
    const Vec3f extinction{0.5f, 0.5f, 0.5f};
    const double to_eye = 0.5;
    const PunctualLight lamp = lamp_at({6, 8, 0});
    const double open = lit_through({}, lamp, extinction, 0);
    EXPECT_NEAR(lit_through({4, 8.25f}, lamp, extinction, 0) / open,
                std::exp(-0.5 * (1 + 0.25) / 0.8),
                1e-4);
    EXPECT_NEAR(lit_through({0.25f, 4}, lamp, extinction, 0) / open,
                std::exp(-0.5 * ((0.75 + 1) / 0.8 + to_eye)),
                1e-4);
    const double sunny = lit_through({}, slanting_sun(), extinction, 0);
    EXPECT_NEAR(lit_through({0.25f}, slanting_sun(), extinction, 0) / sunny,
                std::exp(-0.5 * (0.75 / 0.8 + to_eye)),
                1e-4);
}

TEST(MediaLights, WhatRefractsAndWhatIsOpaqueBlocks) {
    for (const bool glass : {false, true}) {
        ThinWallScene floor;
        floor.light(slanting_sun());
        const int32_t cloud = floor.add(glass_material(), fog({0.1f, 0.1f, 0.1f}, 0));
        MaterialLayers body = dielectric(1.5f, {0, 0, 0});
        if (!glass) body = MaterialLayers{};
        const int32_t other = floor.add(glass_material(), body);
        Scene scene = floor.take();
        number_media(scene);
        add_shape(scene, make_shape(ShapeKind::box, 40, 0.5f, 40), cloud, raised(2.5));
        add_shape(scene, make_shape(ShapeKind::box, 40, 0.5f, 40), other, raised(4.5));
        EXPECT_EQ(floor_value(std::move(scene)), 0) << glass;
    }
}

/// Clouds in front of a wall, lit by a sky with a sun, a panel above and one inside.
Scene lit_clouds(float g) {
    DielectricScene dielectrics;
    const int32_t cloud = dielectrics.add(fog({1.0f, 2.0f, 4.0f}, 0.9f, g));
    Material panel;
    panel.base_color[0] = panel.base_color[1] = panel.base_color[2] = 0;
    panel.flags = material_double_sided;
    std::fill_n(panel.emission, 3, 20.0f);
    SceneBuilder& builder = dielectrics.builder;
    const int32_t glows = builder.material(panel);
    builder.quad({0.8f, 1.5f, -0.5f}, {0, 0, 1}, {1, 0, 0}, glows);
    builder.quad({0.3f, -0.1f, 0}, {0, 0.2f, 0}, {0.2f, 0, 0}, glows);
    Material wall;
    wall.metallic = 0;
    wall.roughness = 1;
    builder.quad({-3, -3, -1.5f}, {6, 0, 0}, {0, 6, 0}, builder.material(wall));
    Scene scene = dielectrics.take();
    add_shape(scene, make_shape(ShapeKind::sphere, 1), cloud);
    return scene;
}

TEST(MediaLights, LightSamplingAndThePhaseFunctionFindTheSameLight) {
    ImageRgb32f sky{64, 32, {}};
    sky.pixels.assign(64 * 32 * 3, 0.2f);
    std::fill_n(sky.pixels.begin() + (6 * 64 + 20) * 3, 3, 100.0f);
    FrontView view{.samples = 256};
    view.lighting.environment = shared(sky);
    for (const float g : {0.0f, 0.7f}) {
        SCOPED_TRACE(g);
        const Film both = film_from_front(lit_clouds(g), view);
        for (const int strategies : {sample_lights, sample_bsdfs}) {
            FrontView one = view;
            one.strategies = strategies;
            one.seed = static_cast<uint64_t>(strategies);
            one.samples = strategies == sample_bsdfs ? 2048 : 256;
            const Film film = film_from_front(lit_clouds(g), one);
            for (const size_t c : {0U, 1U, 2U}) {
                const Mean a = film_mean(both, c);
                const Mean b = film_mean(film, c);
                const double sigma = std::hypot(a.error, b.error);
                EXPECT_NEAR(b.value, a.value, 4 * sigma) << strategies << ", " << c;
                EXPECT_LT(sigma, 0.05 * a.value) << "too noisy to tell anything";
            }
        }
    }
}

/// Fog that absorbs nothing cannot be seen before a sky that is the same everywhere. A faint lamp
/// turns paths towards it.
TEST(MediaLights, ALampInFogTakesNothingFromTheSky) {
    PunctualLight lamp = lamp_at({0.3f, 0.1f, -0.2f});
    std::fill_n(lamp.intensity, 3, 1e-5f);
    FrontView view{.samples = 2048};
    view.lighting.environment = constant_environment(1);
    for (const float g : {-0.7f, 0.0f, 0.7f}) {
        const Mean seen = film_mean(film_from_front(cube_of(fog({2, 2, 2}, 1, g), {lamp}), view));
        EXPECT_LT(seen.error, 2e-3) << g;
        EXPECT_NEAR(seen.value, 1, 4 * seen.error + 1e-3) << g;
    }
}

/// Fog around the eye, at the index of air and of water: shadow rays stay inside. The boundary of
/// water reflects a fiftieth.
TEST(MediaLights, InTheMediumAroundTheEyeLampsAreSampledWhateverItsIndex) {
    MaterialLayers water = fog({0.5f, 0.5f, 0.5f}, faint);
    const PunctualLight lamp = lamp_at({0.4f, 0.3f, -0.2f});
    const auto seen = [&](float ior) {
        water.ior = ior;
        RenderOptions options;
        options.width = options.height = image_size;
        options.samples_per_pixel = 1024;
        const Camera camera = look_at({0, 0, 0.9f}, {0, 0, 0}, 1e-3f, image_size, image_size);
        return film_mean(render_scene(cube_of(water, {lamp}), {}, camera, options).film);
    };
    const Mean air = seen(1);
    const Mean other = seen(1.33f);
    EXPECT_GT(air.value, 1e-5);
    EXPECT_NEAR(other.value, air.value, 4 * std::hypot(air.error, other.error) + 0.03 * air.value);
}

}  // namespace media_lights_truth
}  // namespace obscura::test
