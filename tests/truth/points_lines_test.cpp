// tests/truth/points_lines_test.cpp - rendered points and lines: sizes, colours, AOVs.
// SPDX-License-Identifier: Apache-2.0
#include "render/film_rows.h"
#include "render/points_lines_sizes.h"
#include "stages/dispatch.h"

#include <gtest/gtest.h>

#include "support/points_lines_scenes.h"
#include "truth/reference.h"

namespace obscura::test {
namespace points_lines_truth {

constexpr int side = 96;

RenderOptions image(Integrator integrator, int samples = 1) {
    RenderOptions options;
    options.width = side;
    options.height = side;
    options.samples_per_pixel = samples;
    options.integrator = integrator;
    options.background = BackgroundKind::transparent;
    return options;
}

Material unlit() {
    Material m;
    m.flags = material_unlit;
    return m;
}

Camera from_front(float eye_z) {
    return look_at({0, 0, eye_z}, {0, 0, 0}, 0.6F, side, side);
}

constexpr PointsLinesSizes in_metres(double diameter) {
    return {{diameter, LengthUnit::metres}, {diameter, LengthUnit::metres}};
}

constexpr PointsLinesSizes in_pixels(double diameter) {
    return {{diameter, LengthUnit::pixels}, {diameter, LengthUnit::pixels}};
}

Film draw(Scene scene, const Camera& camera, const RenderOptions& options) {
    return render_scene(std::move(scene), {}, camera, options).film;
}

double alpha_at(const Film& film, int x, int y) {
    return static_cast<double>(film.pixels[pixel_index(film, x, y) * film.channels.size() + 3]);
}

/// Pixels that are covered in a column or row of the image.
double covered_in_column(const Film& film, int x, int first, int end) {
    double sum = 0;
    for (int y = first; y < end; ++y)
        sum += alpha_at(film, x, y);
    return sum;
}

double covered(const Film& film) {
    double sum = 0;
    for (int x = 0; x < side; ++x)
        sum += covered_in_column(film, x, 0, side);
    return sum;
}

TEST(PointsLines, APointCoversItsDisk) {
    const Camera camera = from_front(10);
    for (const double diameter : {0.3, 1.1}) {
        Scene scene = empty_scene(unlit());
        add_points(scene, {{{0.2F, -0.1F, 0}}}, 1);
        size_points_lines(in_metres(diameter), camera, scene);
        const double pixel_m = pixel_size_m(camera, {0, 0, 0});
        const double expected = pi_d / 4 * diameter * diameter / (pixel_m * pixel_m);
        const double got = covered(draw(scene, camera, image(Integrator::path, 256)));
        EXPECT_NEAR(got, expected, 0.02 * expected) << diameter;
    }
}

TEST(PointsLines, PixelsAreThoseOfEveryCamera) {
    Camera flat = from_front(10);
    EXPECT_NEAR(pixel_size_m(flat, {3, 1, 6}), 4 * 2 * std::tan(0.3) / side, 1e-7);
    EXPECT_NEAR(pixel_size_m(flat, {3, 1, 14}), 4 * 2 * std::tan(0.3) / side, 1e-7);
    flat.model = CameraModel::orthographic;
    flat.orthographic.pixel_width_m = 0.25F;
    EXPECT_EQ(pixel_size_m(flat, {3, 1, 6}), 0.25);
    Camera round = from_front(10);
    round.model = CameraModel::fisheye;
    round.fisheye.pixel_spread = 0.01F;
    EXPECT_NEAR(pixel_size_m(round, {3, 0, 6}), 5 * 0.01, 1e-6);
}

TEST(PointsLines, ALineIsAsWideNearAndFar) {
    const Camera camera = from_front(10);
    for (const double width : {1.0, 6.0}) {
        Scene scene = empty_scene(unlit());
        add_strip(scene, {{{-9, 1, 4}}, {{9, 1, 4}}}, 1);
        add_strip(scene, {{{-90, -6, -30}}, {{90, -6, -30}}}, 1);
        size_points_lines(in_pixels(width), camera, scene);
        const Film film = draw(scene, camera, image(Integrator::path, 256));
        double near = 0;
        double far = 0;
        for (int x = 20; x < 76; ++x) {
            near += covered_in_column(film, x, 0, side / 2) / 56;
            far += covered_in_column(film, x, side / 2, side) / 56;
        }
        EXPECT_NEAR(near, width, 0.03 * width);
        EXPECT_NEAR(far, width, 0.03 * width);
    }
}

/// A line on the floor that passes under the eye is as wide below as it is at the horizon.
TEST(PointsLines, ALineThatPassesTheEyeGetsThinTowardsIt) {
    const Camera camera = from_front(10);
    Scene scene = empty_scene(unlit());
    add_strip(scene, {{{0, -1, -100}}, {{0, -1, 100}}}, 1);
    size_points_lines(in_pixels(4), camera, scene);
    EXPECT_EQ(scene.curve_segments.size(), 2U);
    const Film film = draw(scene, camera, image(Integrator::path, 256));
    for (const int y : {60, 75, 92}) {
        double width = 0;
        for (int x = 0; x < side; ++x)
            width += alpha_at(film, x, y);
        EXPECT_NEAR(width, 4, 0.15) << y;
    }
}

TEST(PointsLines, ColoursGoFromEndToEnd) {
    const Camera camera = from_front(10);
    Scene scene = empty_scene(unlit());
    add_strip(scene, {{{-2, 0, 0}, 0.25F}, {{0, 0, 0}, 1}, {{2, 0, 0}, 0}}, 0.5F);
    add_points(scene, {{{0, 2, 0}, 0.375F}, {{-2, -2, 0}, 0.75F}}, 0.3F);
    const Film film = draw(scene, camera, image(Integrator::albedo));
    const size_t channels = film.channels.size();
    const double pixel_m = pixel_size_m(camera, {0, 0, 0.5});
    const auto red_at = [&](int x, int y) {
        const size_t pixel = static_cast<size_t>(y) * side + static_cast<size_t>(x);
        return static_cast<double>(film.pixels[pixel * channels]);
    };
    for (int x = 24; x < 72; ++x) {
        const double at = (x + 0.5 - side / 2.0) * pixel_m;
        if (std::abs(at) > 1.7) continue;
        const double expected = at < 0 ? 1 + at / 2 * 0.75 : 1 - at / 2;
        EXPECT_NEAR(red_at(x, side / 2), expected, 0.012) << x;
    }
    const auto pixel = [&](double metres) {
        return static_cast<int>(side / 2.0 + metres / pixel_size_m(camera, {0, 0, 0}));
    };
    EXPECT_EQ(red_at(pixel(0), pixel(-2)), 0.375);
    EXPECT_EQ(red_at(pixel(-2), pixel(2)), 0.75);
}

TEST(PointsLines, AovsKnowThem) {
    const Camera camera = from_front(10);
    Scene scene = empty_scene(unlit());
    add_points(scene, {{{0, 2, 0}}, {{0, 2, -50}}}, 0.3F);
    add_strip(scene, {{{-3, 1, 0}}, {{-2, 0, 0}}, {{2, 0, 0}}}, 0.5F);
    const size_t middle = (side / 2) * (side + 1);
    const Film id = draw(scene, camera, image(Integrator::id));
    const size_t channels = id.channels.size();
    EXPECT_EQ(id.pixels[middle * channels], 2) << "node 1";
    EXPECT_EQ(id.pixels[middle * channels + 1], 1) << "material 0";
    EXPECT_EQ(id.pixels[middle * channels + 2], 2) << "the strip's second piece";
    const Film depth = draw(scene, camera, image(Integrator::depth));
    EXPECT_NEAR(depth.pixels[middle * depth.channels.size()], 9.5, 0.02);
    const Film normal = draw(scene, camera, image(Integrator::normal));
    const size_t at = middle * normal.channels.size();
    const double off = -0.5 / side * 2 * std::tan(0.3) * 9.5 / 0.5;  // half a pixel from the axis
    EXPECT_NEAR(normal.pixels[at], 0, 1e-5);
    EXPECT_NEAR(normal.pixels[at + 1], off, 0.02 * std::abs(off));
    EXPECT_NEAR(normal.pixels[at + 2], 1, 0.01);
    const Film heat = draw(scene, camera, image(Integrator::heat));
    EXPECT_GT(heat.pixels[middle * heat.channels.size()], 0);
    EXPECT_EQ(heat.pixels[0], 0);
}

/// A spiral whose segments meet at angles, in a scene far from the origin.
Scene spiral(const Material& material, const Vec3f& centre) {
    Scene scene = empty_scene(material);
    std::vector<Dot> dots;
    for (int i = 0; i < 40; ++i) {
        const float angle = 0.5F * static_cast<float>(i);
        const float radius = 0.05F * static_cast<float>(i);
        const Vec3f turn{std::cos(angle) * radius, std::sin(angle) * radius, 0};
        dots.push_back({centre + turn + Vec3f{0, 0, 0.5F * std::sin(3 * angle)}});
    }
    add_strip(scene, dots, 0.06F);
    return scene;
}

/// White points and lines under a white sky are invisible: rays that leave them neither meet them
/// again nor get inside.
TEST(PointsLines, VanishInAFurnace) {
    Material white;
    std::fill_n(white.base_color, 3, 1.0F);
    white.metallic = 0;
    white.roughness = 1;
    for (const float place : {0.0F, 300.0F}) {
        const Vec3f centre{place, 2 * place, -place};
        RenderOptions options = image(Integrator::path, 16);
        options.max_bounces = 200;
        options.background = BackgroundKind::environment;
        LightingOptions sky;
        sky.environment = constant_environment(1);
        const Camera camera = look_at(centre + Vec3f{0, 0, 8}, centre, 0.6F, side, side);
        const Film film = render_scene(spiral(white, centre), sky, camera, options).film;
        EXPECT_NEAR(film_mean(film).value, 1, 0.004) << place;
        const size_t channels = film.channels.size();
        for (size_t i = 0; i < film.pixels.size(); i += channels)
            ASSERT_NEAR(film.pixels[i], 1, 0.4) << i / channels << " at " << place;
    }
}

TEST(PointsLines, AlphaLetsPassAsMuchAsItSays) {
    Material half = unlit();
    half.flags |= material_alpha_blend;
    half.base_color[3] = 0.5F;
    const Camera camera = from_front(10);
    for (const bool line : {true, false}) {
        Scene scene = empty_scene(half);
        if (line) add_strip(scene, {{{-1, 0, 0}}, {{1, 0, 0}}}, 0.5F);
        if (!line) add_points(scene, {{{0, 0, 0}}}, 0.5F);
        RenderOptions options = image(Integrator::path, 1024);
        options.crop = PixelRect{side / 2 - 2, side / 2 - 2, 4, 4};
        const Film film = draw(scene, camera, options);
        // Entry and exit of a ray are one decision.
        EXPECT_NEAR(alpha_at(film, side / 2, side / 2), 0.5, 0.06) << line;
    }
}

TEST(PointsLines, AllInstructionSetsAgree) {
    if (!has_isa(Isa::baseline)) GTEST_SKIP() << "this build has one set alone (OBSCURA_ISAS)";
    const Camera camera = from_front(10);
    Scene scene = spiral(unlit(), {0, 0, 0});
    add_points(scene, {{{0, 2, 0}, 0.375F}, {{-2, -2, 0}, 0.75F}}, 0.3F);
    for (const Integrator integrator : {Integrator::normal, Integrator::albedo}) {
        const Film film = render_scene(scene, {}, camera, image(integrator), Isa::baseline).film;
        for (const Isa isa : {Isa::avx2, Isa::avx512}) {
            if (!has_isa(isa)) continue;
            const Film other = render_scene(scene, {}, camera, image(integrator), isa).film;
            size_t different = 0;
            for (size_t i = 0; i < film.pixels.size(); ++i)
                different += std::abs(film.pixels[i] - other.pixels[i]) > 1e-3F ? 1U : 0U;
            EXPECT_LE(different, film.pixels.size() / 500) << "outlines may differ by a pixel";
        }
    }
}

}  // namespace points_lines_truth
}  // namespace obscura::test
