// tests/truth/points_lines_textures_test.cpp - textures on points and lines.
// SPDX-License-Identifier: Apache-2.0
#include "render/points_lines_sizes.h"

#include <gtest/gtest.h>

#include "support/points_lines_scenes.h"
#include "truth/reference.h"

namespace obscura::test {
namespace points_lines_textures_truth {

constexpr int side = 96;

/// A line of four grey texels as data, 0, 1/3, 2/3 and 1, between which it is bilinear.
TextureArena ramp() {
    TextureArena arena;
    for (const uint32_t grey : {0U, 85U, 170U, 255U})
        arena.texels.push_back(grey | grey << 8 | grey << 16 | 255U << 24);
    TextureRecord record;
    record.width = 4;
    record.height = 1;
    record.levels = 1;
    record.level_offset[0] = 0;
    record.sampler = pack_sampler(Wrap::clamp, Wrap::clamp, false, false, MipMode::none, false);
    arena.records = {record};
    return arena;
}

/// Gives the last primitive texture coordinates, u by vertex.
void add_u(Scene& scene, int set, const std::vector<float>& u) {
    Primitive& primitive = scene.primitives.back();
    const bool lines = primitive.geometry == static_cast<int32_t>(GeometryKind::curves);
    const size_t index = static_cast<size_t>(primitive.first_triangle);
    const size_t first = lines ? scene.curve_segments[index] : index;
    primitive.uv_base[set] =
        static_cast<int32_t>(scene.attributes.size()) - static_cast<int32_t>(2 * first);
    for (const float x : u)
        scene.attributes.insert(scene.attributes.end(), {x, 0.5F});
    scene.attributes.resize(scene.attributes.size() + 4);  // gathers read four words
}

/// A line from u = 1/8 to 7/8 over its two segments, behind a strip without coordinates, and points
/// at the centres of texels.
Scene textured_points_lines(const Material& material, int set) {
    Scene scene = empty_scene(material);
    add_strip(scene, {{{-3, 3, 0}}, {{3, 3, 0}}, {{3, 4, 0}}}, 0.01F);
    add_strip(scene, {{{-2, 0, 0}}, {{0, 0, 0}}, {{2, 0, 0}}}, 0.5F);
    add_u(scene, set, {0.125F, 0.5F, 0.875F});
    add_points(scene, {{{-1, -2, 0}}, {{0, -2, 0}}, {{1, -2, 0}}}, 0.3F);
    add_u(scene, set, {0.375F, 0.875F, 0.625F});
    scene.textures = ramp();
    return scene;
}

Material textured(int set) {
    Material m;
    m.flags = material_unlit;
    m.base_color[0] = 0.5F;
    m.base_color_texture.texture = 0;
    m.base_color_texture.uv_set = set;
    return m;
}

Film draw(Scene scene, Integrator integrator, int samples) {
    RenderOptions options;
    options.width = side;
    options.height = side;
    options.samples_per_pixel = samples;
    options.integrator = integrator;
    options.background = BackgroundKind::transparent;
    const Camera camera = look_at({0, 0, 10}, {0, 0, 0}, 0.6F, side, side);
    return render_scene(std::move(scene), {}, camera, options).film;
}

double red_at(const Film& film, double x_m, double y_m) {
    const double pixel_m = 20 * std::tan(0.3) / side;
    const auto x = static_cast<size_t>(side / 2.0 + x_m / pixel_m);
    const auto y = static_cast<size_t>(side / 2.0 - y_m / pixel_m);
    return static_cast<double>(film.pixels[(y * side + x) * film.channels.size()]);
}

TEST(PointsLinesTextures, LinesReadThemAlongAndPointsAtOnePlace) {
    for (const int set : {0, 3}) {
        for (const Integrator integrator : {Integrator::albedo, Integrator::path}) {
            const Film film = draw(textured_points_lines(textured(set), set), integrator, 256);
            for (const double x : {-1.6, -0.9, -0.3, 0.4, 1.1, 1.7}) {
                // Half a radius nearer, things look larger, and pixels have a width.
                EXPECT_NEAR(red_at(film, x * 10 / 9.5, 0), 0.5 * (x + 2) / 4, 0.02) << x;
            }
            EXPECT_NEAR(red_at(film, -1, -2), 0.5 / 3, 1e-4);
            EXPECT_NEAR(red_at(film, 0, -2), 0.5, 1e-4);
            EXPECT_NEAR(red_at(film, 1, -2), 1.0 / 3, 1e-4);
        }
    }
}

/// Without light the sum of both is seen, each with its texture.
TEST(PointsLinesTextures, EmissionIsAddedWhereThereIsNoLight) {
    Material m = textured(0);
    m.emission[0] = 2;
    for (const bool emissive : {false, true}) {
        if (emissive) m.emissive_texture = m.base_color_texture;
        const double factor = emissive ? 1.0 / 3 : 1;
        for (const Integrator integrator : {Integrator::path, Integrator::raycast}) {
            const Film film = draw(textured_points_lines(m, 0), integrator, 16);
            EXPECT_NEAR(red_at(film, -1, -2), 0.5 / 3 + 2 * factor, 1e-4);
        }
    }
}

TEST(PointsLinesTextures, AlphaLetsPassAsMuchAsTheTexelSays) {
    Material m = textured(0);
    m.flags |= material_alpha_blend;
    Scene scene = textured_points_lines(m, 0);
    scene.textures.texels[1] = 0xFFU | 0x40U << 24;
    const Film film = draw(scene, Integrator::path, 512);
    EXPECT_NEAR(red_at(film, -1, -2), 0.5 * 0x40 / 255, 0.035);
}

TEST(PointsLinesTextures, TheirCoordinatesAreAnAov) {
    const Film film = draw(textured_points_lines(textured(0), 0), Integrator::uv, 1);
    EXPECT_NEAR(red_at(film, 0, -2), 0.875, 1e-6);
    EXPECT_NEAR(red_at(film, 1, 0), 0.125 + 0.75 * 2.95 / 4, 0.01);
    EXPECT_EQ(red_at(film, 0, 3), 0) << "without coordinates";
}

}  // namespace points_lines_textures_truth
}  // namespace obscura::test
