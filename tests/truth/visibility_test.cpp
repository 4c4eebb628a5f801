// tests/truth/visibility_test.cpp - holdouts, what the camera or shadows pass, and shadow catchers.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/thin_wall_scenes.h"

namespace obscura::test {
namespace visibility_truth {

constexpr int size = 32;

/// What the scenes have: a floor y = 0 (primitive 0) and a ball above it (primitive 1).
struct FloorScene {
    bool has_floor = true;
    bool has_ball = true;
    float ball_grey = 0;              ///< unlit, so that it sends no light on
    std::vector<uint8_t> flags = {};  ///< by primitive
    bool sun = false;
    bool lamp = false;  ///< an emissive square above everything
};

/// Diffuse alone: catchers have no gloss.
Scene floor_scene(const FloorScene& wanted) {
    SceneBuilder builder;
    Material floor;
    floor.metallic = 0;
    floor.roughness = 1;
    floor.layers = 0;
    std::fill_n(floor.base_color, 3, 0.5f);
    MaterialLayers matt;
    matt.specular = 0;
    Material ball;
    ball.flags = material_unlit;
    std::fill_n(ball.base_color, 3, wanted.ball_grey);
    Material lamp;
    std::fill_n(lamp.emission, 3, 20.0f);
    std::fill_n(lamp.base_color, 3, 0.0f);
    for (const Material& material : {floor, ball, lamp})
        builder.material(material);
    if (wanted.has_floor) builder.quad({-40, 0, 40}, {80, 0, 0}, {0, 0, -80}, 0);
    if (wanted.has_ball) builder.sphere({0, 0.5f, 0}, 0.5f, 32, 1, false, true);
    if (wanted.lamp) builder.quad({-1, 3, -1}, {2, 0, 0}, {0, 0, 2}, 2);
    Scene scene = builder.take();
    scene.layers = {matt};
    if (wanted.sun) scene.lights = {slanting_sun()};
    scene.visibility.primitives = wanted.flags;
    return scene;
}

/// A sky that is brighter on one side.
LightingOptions sky() {
    LightingOptions out;
    ImageRgb32f image;
    image.width = 16;
    image.height = 8;
    for (int i = 0; i < 16 * 8; ++i) {
        const float bright = i % 16 < 5 ? 2.0f : 0.5f;
        image.pixels.insert(image.pixels.end(), {bright, 0.8f * bright, 0.6f * bright});
    }
    out.environment = shared(image);
    return out;
}

RenderOptions options_of(int samples, Integrator integrator = Integrator::path) {
    RenderOptions options;
    options.width = options.height = size;
    options.samples_per_pixel = samples;
    options.integrator = integrator;
    options.background = BackgroundKind::transparent;
    return options;
}

Film film_of(const FloorScene& scene,
             const LightingOptions& lighting,
             const RenderOptions& options) {
    const Camera camera = look_at({0, 3, 4}, {0, 0, 0}, 0.7f, size, size);
    return render_scene(floor_scene(scene), lighting, camera, options).film;
}

float at(const Film& film, int pixel, int channel) {
    return film.pixels[static_cast<size_t>(pixel) * 4 + static_cast<size_t>(channel)];
}

/// Root mean square difference between a film over a plate and what it should be, and the greatest
/// alpha beside the ball.
struct Difference {
    double rms = 0;
    double bias = 0;
};

Difference over_plate(const Film& catcher, const Film& plate, const Film& direct) {
    Difference out;
    for (int p = 0; p < size * size; ++p) {
        for (int c = 0; c < 3; ++c) {
            const float over = at(catcher, p, c) + (1 - at(catcher, p, 3)) * at(plate, p, c);
            const double off = static_cast<double>(over - at(direct, p, c));
            out.rms += off * off / (3.0 * size * size);
            out.bias += off / (3.0 * size * size);
        }
    }
    out.rms = std::sqrt(out.rms);
    return out;
}

/// The catcher over the lit floor must be the floor with the ball's shadow.
void expect_true_shadow(FloorScene scene,
                        const LightingOptions& lighting,
                        bool ground,
                        double noise) {
    const RenderOptions options = options_of(256);
    const Film direct = film_of(scene, lighting, options);
    scene.has_ball = false;
    const Film plate = film_of(scene, lighting, options);
    scene.has_ball = true;
    RenderOptions catching = options;
    if (ground) {
        scene.has_floor = false;
        catching.catcher_ground_m = 0;
    } else {
        scene.flags.assign(scene.lamp ? 3 : 2, 0);
        scene.flags[0] = visibility_catcher;
    }
    const Film catcher = film_of(scene, lighting, catching);
    const Difference difference = over_plate(catcher, plate, direct);
    EXPECT_LT(difference.rms, noise);
    EXPECT_LT(std::abs(difference.bias), noise / 4);
    double darkest = 0;
    for (int p = 0; p < size * size; ++p)
        darkest = std::max(darkest, static_cast<double>(at(catcher, p, 3)));
    EXPECT_EQ(darkest, 1);  // the ball itself
    const double without = over_plate(plate, plate, direct).rms;
    EXPECT_GT(without, 4 * noise);  // the shadow is no trifle
}

TEST(ShadowCatcher, OverTheLitFloorItIsTheShadowOfTheSun) {
    LightingOptions dark = sky();
    dark.environment_intensity = 0;
    expect_true_shadow({.sun = true}, dark, true, 0.01);
    expect_true_shadow({.sun = true}, dark, false, 0.01);
}

TEST(ShadowCatcher, AndOfTheSky) {
    expect_true_shadow({}, sky(), true, 0.01);
    expect_true_shadow({}, sky(), false, 0.01);
}

TEST(ShadowCatcher, AndOfALamp) {
    LightingOptions dark = sky();
    dark.environment_intensity = 0;
    expect_true_shadow({.lamp = true}, dark, false, 0.05);
}

/// Where nothing shadows it, every sample has the same light with and without shadow rays.
TEST(ShadowCatcher, WithoutAShadowItIsNotThere) {
    RenderOptions options = options_of(8);
    options.catcher_ground_m = 0;
    const Film film = film_of({.has_floor = false, .has_ball = false, .sun = true}, sky(), options);
    for (const float value : film.pixels)
        ASSERT_EQ(value, 0);
    options.background = BackgroundKind::environment;
    const Film before =
        film_of({.has_floor = false, .has_ball = false, .sun = true}, sky(), options);
    options.catcher_ground_m.reset();
    const Film open = film_of({.has_floor = false, .has_ball = false, .sun = true}, sky(), options);
    for (size_t i = 0; i < open.pixels.size(); ++i)
        ASSERT_NEAR(before.pixels[i], open.pixels[i], 1e-5f);
}

TEST(ShadowCatcher, TilesAndCropsChangeNoBit) {
    RenderOptions options = options_of(5);
    options.catcher_ground_m = 0;
    options.catcher_reflections = true;
    const FloorScene scene{.has_floor = false, .ball_grey = 0.7f, .sun = true};
    const Film whole = film_of(scene, sky(), options);
    options.tile_size = 5;
    const Film tiled = film_of(scene, sky(), options);
    EXPECT_TRUE(std::equal(whole.pixels.begin(), whole.pixels.end(), tiled.pixels.begin()));
    options.crop = PixelRect{7, 11, 9, 13};
    const Film part = film_of(scene, sky(), options);
    for (int y = 0; y < 13; ++y) {
        for (int x = 0; x < 9 * 4; ++x) {
            ASSERT_EQ(part.pixels[static_cast<size_t>(y * 9 * 4 + x)],
                      whole.pixels[static_cast<size_t>(((y + 11) * size + 7) * 4 + x)]);
        }
    }
}

/// A catcher throws no light and no shadow: the ball is as it is alone.
TEST(ShadowCatcher, ItLightsAndShadowsNothing) {
    const FloorScene alone{.has_floor = false, .ball_grey = 0.25f};
    const FloorScene caught{.ball_grey = 0.25f, .flags = {visibility_catcher, 0}};
    const Film a = film_of(alone, sky(), options_of(4));
    const Film b = film_of(caught, sky(), options_of(4));
    for (int p = 0; p < size * size; ++p) {
        if (at(a, p, 3) == 1) {
            ASSERT_EQ(at(a, p, 0), at(b, p, 0));
        }
    }
}

/// The reflection of a white ball is light in the image, where without there is only shadow.
TEST(ShadowCatcher, ReflectionsAddColour) {
    RenderOptions options = options_of(64);
    options.catcher_ground_m = 0;
    const FloorScene scene{.has_floor = false, .ball_grey = 1};
    const Film matt = film_of(scene, sky(), options);
    options.catcher_reflections = true;
    const Film glossy = film_of(scene, sky(), options);
    double gained = 0;
    for (int p = 0; p < size * size; ++p) {
        EXPECT_EQ(at(matt, p, 3), at(glossy, p, 3));
        EXPECT_GE(at(glossy, p, 0), at(matt, p, 0));
        gained = std::max(gained, static_cast<double>(at(glossy, p, 0) - at(matt, p, 0)));
    }
    EXPECT_GT(gained, 0.02);
    EXPECT_LT(gained, 0.4);
}

TEST(Holdout, IsEmptyButShadows) {
    RenderOptions options = options_of(64);
    options.background = BackgroundKind::environment;
    const FloorScene plain{.sun = true};
    FloorScene held = plain;
    held.flags = {0, visibility_holdout};
    const Film with = film_of(plain, sky(), options);
    const Film without = film_of(held, sky(), options);
    const int middle = (size / 2 - 3) * size + size / 2;  // on the ball
    ASSERT_EQ(at(with, middle, 3), 1);
    for (int c = 0; c < 4; ++c)
        EXPECT_EQ(at(without, middle, c), 0);
    int floor_pixels = 0;
    for (int p = 0; p < size * size; ++p) {
        if (at(without, p, 3) != 1) continue;
        ++floor_pixels;
        ASSERT_EQ(at(with, p, 0), at(without, p, 0));  // with the ball's shadow
    }
    EXPECT_GT(floor_pixels, size * size / 2);
}

TEST(CameraInvisible, IsPassedByTheCameraAlone) {
    const FloorScene plain{.sun = true};
    FloorScene passed = plain;
    passed.flags = {0, visibility_no_camera};
    const Film with = film_of(plain, sky(), options_of(64));
    const Film film = film_of(passed, sky(), options_of(64));
    const Film empty = film_of({.has_ball = false, .sun = true}, sky(), options_of(64));
    const int middle = (size / 2 - 3) * size + size / 2;
    EXPECT_EQ(at(with, middle, 0), 0);
    EXPECT_GT(at(film, middle, 0), 0);  // the floor behind
    for (const int corner : {0, size - 1})
        EXPECT_EQ(at(with, corner, 0), at(film, corner, 0));
    EXPECT_LT(film_mean(film).value, 0.97 * film_mean(empty).value);  // its shadow stays
    double darkest = 1;
    for (int p = 0; p < size * size; ++p) {
        const auto ratio = static_cast<double>(at(film, p, 0) / at(empty, p, 0));
        darkest = std::min(darkest, ratio);
    }
    EXPECT_LT(darkest, 0.6);
}

/// A black ball that casts no shadow leaves the floor as it is without the ball, whichever strategy
/// finds the light.
TEST(NoShadow, TheFloorIsLitAsIfTheBallWereAway) {
    for (const bool lamp : {false, true}) {
        FloorScene scene{.sun = !lamp, .lamp = lamp};
        scene.flags.assign(lamp ? 3 : 2, 0);
        scene.flags[1] = visibility_no_shadow | visibility_no_camera;
        FloorScene empty = scene;
        empty.has_ball = false;
        empty.flags.clear();
        FloorScene ordinary = scene;
        ordinary.flags[1] = visibility_no_camera;
        for (const int strategies : {sample_lights, sample_bsdfs, sample_lights | sample_bsdfs}) {
            RenderOptions options = options_of(64);
            options.max_bounces = 0;
            options.strategies = strategies;
            const double lit = film_mean(film_of(scene, sky(), options)).value;
            const double expected = film_mean(film_of(empty, sky(), options)).value;
            EXPECT_NEAR(lit, expected, 2e-3 * expected) << strategies;
            EXPECT_LT(film_mean(film_of(ordinary, sky(), options)).value, 0.98 * expected);
        }
    }
}

}  // namespace visibility_truth
}  // namespace obscura::test
