// tests/truth/transparent_glass_test.cpp - catchers and plates seen through clear glass.
// SPDX-License-Identifier: Apache-2.0
#include "scene/media.h"

#include <gtest/gtest.h>

#include "support/thin_wall_scenes.h"
#include "truth/dielectric_scene.h"
#include <optional>

namespace obscura::test {
namespace transparent_glass_truth {

constexpr int side = 32;

enum class Form { none, ball, pane, cube };

/// A form of glass, above or on a floor y = 0.
struct GlassScene {
    Form form = Form::ball;
    MaterialLayers glass = {};  ///< smooth
    float roughness = 0;
    Vec3f color{1, 1, 1};
    std::optional<Vec3f> plate = {};  ///< a floor that shines by itself
    std::optional<float> matt = {};   ///< a white floor of this albedo
    bool dark_ball = false;           ///< at the origin
    bool casts_no_shadow = false;     ///< the form
    float bottom = 0.01f;             ///< of the cube, metres
    bool sun = false;
    bool lamp = false;  ///< a panel that shines, for the glass to reflect
};

MaterialLayers clear(float ior, bool solid) {
    MaterialLayers out = solid ? dielectric(ior, {0, 0, 0}) : glass_layers();
    out.ior = ior;
    return out;
}

Scene build(const GlassScene& wanted) {
    DielectricScene scene;
    const int32_t glass = scene.add(wanted.glass);
    MaterialLayers without_gloss;
    without_gloss.specular = 0;
    const int32_t floor = scene.add(without_gloss);
    const int32_t dark = scene.add({});
    SceneBuilder& builder = scene.builder;
    std::vector<Material>& materials = builder.scene().materials;
    const auto at = [&](int32_t index) -> Material& {
        return materials[static_cast<size_t>(index)];
    };
    at(glass).roughness = wanted.roughness;
    at(glass).base_color[0] = wanted.color.x;
    at(glass).base_color[1] = wanted.color.y;
    at(glass).base_color[2] = wanted.color.z;
    at(floor).roughness = 1;
    at(floor).flags = 0;
    if (wanted.plate) {
        at(floor).flags = material_unlit;
        const Vec3f& plate = *wanted.plate;
        std::copy_n(std::array{plate.x, plate.y, plate.z}.data(), 3, at(floor).base_color);
    } else if (wanted.matt) {
        std::fill_n(at(floor).base_color, 3, *wanted.matt);
    }
    at(dark).flags = material_unlit;
    std::fill_n(at(dark).base_color, 3, 0.0f);
    if (wanted.form == Form::ball) builder.sphere({0, 0.7f, 0}, 0.6f, 32, glass);
    if (wanted.form == Form::pane)
        builder.quad({-0.8f, 0.5f, 0.8f}, {1.6f, 0, 0}, {0, 0, -1.6f}, glass);
    if (wanted.form == Form::cube)
        scene.box({-0.7f, wanted.bottom, -0.7f}, {0.7f, 1.4f, 0.7f}, glass);
    const size_t form = builder.scene().primitives.size();
    if (wanted.plate || wanted.matt) builder.quad({-90, 0, 90}, {180, 0, 0}, {0, 0, -180}, floor);
    if (wanted.dark_ball) builder.sphere({0, 0.4f, 0}, 0.3f, 16, dark, false, true);
    if (wanted.lamp) {
        Material lamp;
        lamp.flags = material_double_sided;
        std::copy_n(std::array{4.0f, 3.0f, 2.0f}.data(), 3, lamp.emission);
        builder.quad({-1.5f, 2, 0.5f}, {1.2f, 0.5f, 0}, {0, 0, -2}, builder.material(lamp));
    }
    Scene out = scene.take();
    if (wanted.sun) out.lights = {slanting_sun()};
    if (wanted.casts_no_shadow) {
        out.visibility.primitives.assign(out.primitives.size(), 0);
        std::fill_n(out.visibility.primitives.begin(), form, visibility_no_shadow);
    }
    return out;
}

/// An environment that is brighter on one side, above the horizon, and of one colour below it.
LightingOptions sky_over(const Vec3f& below) {
    LightingOptions out;
    ImageRgb32f image;
    image.width = 64;
    image.height = 64;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const float bright = x < 20 ? 2.0f : 0.5f;
            const Vec3f above{bright, 0.8f * bright, 0.6f * bright};
            const Vec3f color = y < 32 ? above : below;
            image.pixels.insert(image.pixels.end(), {color.x, color.y, color.z});
        }
    }
    out.environment = shared(image);
    return out;
}

LightingOptions all_around(const Vec3f& color) {
    ImageRgb32f image{4, 2, {}};
    for (int i = 0; i < 8; ++i)
        image.pixels.insert(image.pixels.end(), {color.x, color.y, color.z});
    LightingOptions out;
    out.environment = shared(std::move(image));
    return out;
}

RenderOptions settings(int samples) {
    RenderOptions options;
    options.width = options.height = side;
    options.samples_per_pixel = samples;
    options.background = BackgroundKind::transparent;
    options.max_bounces = 16;
    return options;
}

Film film_of(const GlassScene& scene, const LightingOptions& light, const RenderOptions& options) {
    const Camera camera = look_at({0, 3, 3}, {0, 0.4f, 0}, 0.6f, side, side);
    return render_scene(build(scene), light, camera, options).film;
}

RenderOptions catching(RenderOptions options) {
    options.catcher_ground_m = 0;
    return options;
}

double at(const Film& film, int pixel, int channel) {
    return static_cast<double>(film.pixels[static_cast<size_t>(pixel * 4 + channel)]);
}

struct Difference {
    double rms = 0;
    double bias = 0;
};

/// How far a film over a plate, a colour of each pixel, is from what it should be.
template <typename Plate>
Difference over(const Film& film, const Plate& plate, const Film& direct) {
    Difference out;
    constexpr double count = 3.0 * side * side;
    for (int p = 0; p < side * side; ++p) {
        for (int c = 0; c < 3; ++c) {
            const double composed = at(film, p, c) + (1 - at(film, p, 3)) * plate(p, c);
            const double off = composed - at(direct, p, c);
            out.rms += off * off / count;
            out.bias += off / count;
        }
    }
    out.rms = std::sqrt(out.rms);
    return out;
}

/// Glass that casts no shadow, over a plate that the environment continues all around: the
/// composition is the plate seen directly, with what the glass reflects of plate and lamp.
void expect_plate_through(const MaterialLayers& glass, Form form, const Vec3f& plate) {
    GlassScene scene{.form = form, .glass = glass, .casts_no_shadow = true, .lamp = true};
    const LightingOptions light = all_around(plate);
    const Film caught = film_of(scene, light, catching(settings(256)));
    RenderOptions opaque = catching(settings(256));
    opaque.transparent_glass = TransparentGlass::off;
    const Film today = film_of(scene, light, opaque);
    scene.plate = plate;
    const Film direct = film_of(scene, light, settings(256));
    const auto color = [&](int, int c) {
        return static_cast<double>(c == 0 ? plate.x : c == 1 ? plate.y : plate.z);
    };
    const Difference difference = over(caught, color, direct);
    EXPECT_LT(difference.rms, 0.01);
    EXPECT_LT(std::abs(difference.bias), 0.004);  // noise of shadows is one-sided
    // Over another plate, it shows that one.
    const auto black = [](int, int) { return 0.0; };
    EXPECT_LT(over(caught, black, direct).bias, over(today, black, direct).bias - 0.02);
}

TEST(TransparentGlass, APlateThroughABallIsThePlate) {
    expect_plate_through(clear(1.5f, true), Form::ball, {0.4f, 0.4f, 0.4f});
    expect_plate_through(clear(1.5f, true), Form::ball, {0.7f, 0.3f, 0.1f});
}

TEST(TransparentGlass, AndThroughAThinPane) {
    expect_plate_through(clear(1.5f, false), Form::pane, {0.4f, 0.4f, 0.4f});
    expect_plate_through(clear(1.5f, false), Form::pane, {0.1f, 0.3f, 0.7f});
}

/// What absorbs and shadows, but reflects nothing that a catcher would lack: over the lit floor it
/// is the floor beneath, with the shadow.
void expect_floor_through(GlassScene scene, double noise) {
    const LightingOptions light = sky_over({0, 0, 0});
    scene.sun = true;
    const Film caught = film_of(scene, light, catching(settings(1024)));
    scene.matt = 0.5f;
    const Film direct = film_of(scene, light, settings(1024));
    scene.form = Form::none;
    scene.dark_ball = false;
    const Film plate = film_of(scene, light, settings(1024));
    const auto color = [&](int p, int c) { return at(plate, p, c); };
    const Difference difference = over(caught, color, direct);
    EXPECT_LT(difference.rms, noise);
    EXPECT_LT(std::abs(difference.bias), noise / 4);
    EXPECT_GT(over(plate, color, direct).rms, 4 * noise);
}

TEST(TransparentGlass, ItIsAsDarkAsItAbsorbs) {
    GlassScene pane{.form = Form::pane, .glass = clear(1, false), .color = {0.5f, 0.5f, 0.5f}};
    expect_floor_through(pane, 0.02);
    GlassScene cube{.form = Form::cube, .glass = dielectric(1, {0.7f, 0.7f, 0.7f})};
    expect_floor_through(cube, 0.02);
}

TEST(TransparentGlass, ItShowsTheShadowOfWhatIsInIt) {
    const GlassScene cube{.form = Form::cube, .glass = clear(1, true), .dark_ball = true};
    expect_floor_through(cube, 0.02);
}

/// Glass on the ground is as glass just above it.
TEST(TransparentGlass, ItMayStandOnTheGround) {
    GlassScene cube{.form = Form::cube, .glass = clear(1.5f, true), .dark_ball = true, .sun = true};
    const LightingOptions light = sky_over({0, 0, 0});
    const Film above = film_of(cube, light, catching(settings(256)));
    cube.bottom = 0;
    const Film on = film_of(cube, light, catching(settings(256)));
    double difference = 0;
    for (int p = 0; p < side * side; ++p)
        difference += std::abs(at(on, p, 3) - at(above, p, 3)) / (side * side);
    EXPECT_LT(difference, 0.02);
}

/// Over grey plates the mean of the channels is right, over any the tint is lost.
TEST(TransparentGlass, AlphaHoldsTheMeanOfATint) {
    GlassScene scene{.form = Form::pane,
                     .glass = clear(1, false),
                     .color = {0.9f, 0.5f, 0.1f},
                     .casts_no_shadow = true};
    const Film film = film_of(scene, sky_over({1, 1, 1}), catching(settings(256)));
    const int middle = side / 2 * side + side / 2;
    EXPECT_NEAR(at(film, middle, 3), 0.5, 0.01);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(at(film, middle, c), 0, 1e-5);
}

TEST(TransparentGlass, RoughGlassIsOpaque) {
    GlassScene scene{.form = Form::ball, .glass = clear(1.5f, true), .roughness = 0.3f};
    RenderOptions options = catching(settings(16));
    const int middle = side / 2 * side + side / 2;
    EXPECT_EQ(at(film_of(scene, sky_over({1, 1, 1}), options), middle, 3), 1);
    options.clear_roughness = 0.3;
    EXPECT_LT(at(film_of(scene, sky_over({1, 1, 1}), options), middle, 3), 0.7);
}

/// Hardly a path crosses it without scattering, and what scatters has no clear view of the floor.
TEST(TransparentGlass, MediaThatScatterAreOpaque) {
    for (const float ior : {1.0f, 1.5f}) {
        MaterialLayers milk = dielectric(ior, {20, 20, 20});
        std::fill_n(milk.scatter_albedo, 3, 0.99f);
        const GlassScene scene{.form = Form::ball, .glass = milk};
        RenderOptions options = catching(settings(64));
        options.max_bounces = 64;
        const Film film = film_of(scene, sky_over({1, 1, 1}), options);
        EXPECT_EQ(at(film, side / 2 * side + side / 2, 3), 1) << ior;
    }
}

/// Without catchers all is as before, unless it is asked for.
TEST(TransparentGlass, WithoutCatchersItIsAskedFor) {
    const GlassScene scene{.form = Form::ball, .glass = clear(1.5f, true), .sun = true};
    const LightingOptions light = sky_over({0.2f, 0.4f, 0.6f});
    RenderOptions options = settings(64);
    const Film plain = film_of(scene, light, options);
    options.transparent_glass = TransparentGlass::off;
    const Film off = film_of(scene, light, options);
    EXPECT_TRUE(std::equal(plain.pixels.begin(), plain.pixels.end(), off.pixels.begin()));
    options.transparent_glass = TransparentGlass::on;
    const Film on = film_of(scene, light, options);
    const int middle = side / 2 * side + side / 2;
    EXPECT_EQ(at(plain, middle, 3), 1);
    EXPECT_LT(at(on, middle, 3), 0.5);
    // An environment that is seen is seen through glass as ever.
    options.background = BackgroundKind::environment;
    const Film seen = film_of(scene, light, options);
    options.transparent_glass = TransparentGlass::off;
    const Film before = film_of(scene, light, options);
    EXPECT_TRUE(std::equal(seen.pixels.begin(), seen.pixels.end(), before.pixels.begin()));
}

/// A colour behind the scene is what glass shows of it; the environment, too.
TEST(TransparentGlass, TheBackgroundBehindCatchersIsSeenThroughIt) {
    GlassScene scene{.glass = clear(1.5f, true), .casts_no_shadow = true, .lamp = true};
    const Vec3f plate{0.7f, 0.3f, 0.1f};
    const LightingOptions light = all_around(plate);
    GlassScene shining = scene;
    shining.plate = plate;
    const Film direct = film_of(shining, light, settings(256));
    RenderOptions options = catching(settings(256));
    for (const BackgroundKind kind : {BackgroundKind::environment, BackgroundKind::color}) {
        options.background = kind;
        std::copy_n(std::array{plate.x, plate.y, plate.z}.data(), 3, options.background_color);
        const Film film = film_of(scene, light, options);
        const auto none = [](int, int) { return 0.0; };
        EXPECT_LT(over(film, none, direct).rms, 0.01);
        for (int p = 0; p < side * side; ++p)
            ASSERT_NEAR(at(film, p, 3), 1, 1e-5);
    }
}

TEST(TransparentGlass, TilesAndCropsChangeNoBit) {
    const GlassScene scene{.glass = clear(1.5f, true), .color = {0.9f, 0.7f, 0.4f}, .sun = true};
    RenderOptions options = catching(settings(5));
    options.catcher_reflections = true;
    const LightingOptions light = sky_over({0.2f, 0.4f, 0.6f});
    const Film whole = film_of(scene, light, options);
    options.tile_size = 5;
    const Film tiled = film_of(scene, light, options);
    EXPECT_TRUE(std::equal(whole.pixels.begin(), whole.pixels.end(), tiled.pixels.begin()));
    options.crop = PixelRect{7, 11, 9, 13};
    const Film part = film_of(scene, light, options);
    for (int y = 0; y < 13; ++y) {
        for (int x = 0; x < 9; ++x) {
            for (int c = 0; c < 4; ++c)
                ASSERT_EQ(at(part, y * 9 + x, c), at(whole, (y + 11) * side + x + 7, c));
        }
    }
}

}  // namespace transparent_glass_truth
}  // namespace obscura::test
