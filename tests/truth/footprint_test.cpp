// tests/truth/footprint_test.cpp - mip levels follow the footprint: distant chequers are grey.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/arena_images.h"
#include "support/scene_builder.h"
#include "truth/reference.h"

namespace obscura::test {
namespace footprint_truth {

constexpr int image_side = 64;  ///< texels; squares of 8: from level 4 on all is grey
constexpr int film_side = 32;
constexpr double deviation_of_grey = 0.02;

constexpr uint32_t white_texel = 0xFFFFFFFFU, black_texel = 0xFF000000U;

/// A chequer board of black and white squares with its mip chain.
TextureArena chequer_board(MipMode mip) {
    TextureArena arena;
    add_image(
        arena,
        image_side,
        pack_sampler(Wrap::repeat, Wrap::repeat, false, false, mip, true),
        [](int x, int y) { return ((x >> 3) + (y >> 3)) % 2 == 0 ? white_texel : black_texel; });
    return arena;
}

/// A floor of 400 m that shows the board without light, `tiles_per_m` times along each side.
Scene chequered_floor(MipMode mip, float tiles_per_m) {
    SceneBuilder builder;
    Material m;
    m.flags = material_unlit;
    m.base_color_texture.texture = 0;
    builder.quad({-200, 0, 200}, {400, 0, 0}, {0, 0, -400}, builder.material(m));
    Scene scene = builder.take();
    scene.textures = chequer_board(mip);
    scene.primitives[0].uv_base[0] = 0;
    const float end = 400 * tiles_per_m;
    scene.attributes = {0, 0, end, 0, end, end, 0, end, 0, 0, 0, 0};
    return scene;
}

/// From an eye 1 m above the floor. The footprint is a square of the cone's width, stretched by the
/// slant: tiles are so small that only the stretched one covers a grey texel.
struct View {
    float distance_m, yfov_rad, tiles_per_m;
};

/// Over the pixels of a film.
struct Look {
    double mean, deviation;
};

Look look(View view, MipMode mip, Integrator integrator, int samples) {
    // Samples share the pixel: each must cover a grey texel by itself.
    view.tiles_per_m *= std::sqrt(static_cast<float>(samples));
    RenderOptions options;
    options.width = options.height = film_side;
    options.samples_per_pixel = samples;
    options.integrator = integrator;
    const Vec3f eye{0.37f, 1, 0.21f};
    const Camera camera =
        look_at(eye, {0.4f, 0, -view.distance_m}, view.yfov_rad, film_side, film_side);
    const Film film =
        render_scene(chequered_floor(mip, view.tiles_per_m), {}, camera, options).film;
    const Mean mean = film_mean(film);
    return {mean.value, mean.error * film_side};
}

TEST(Footprint, ADistantChequerBoardIsGrey) {
    for (const View& view : {View{20, 0.039f, 4.6f}, View{60, 0.012f, 4.5f}}) {
        for (const auto& [integrator, samples] : {std::pair{Integrator::albedo, 1},
                                                  std::pair{Integrator::path, 1},
                                                  std::pair{Integrator::path, 4},
                                                  std::pair{Integrator::path, 16}}) {
            SCOPED_TRACE(testing::Message() << view.distance_m << " m, " << samples << " spp");
            const Look mips = look(view, MipMode::linear, integrator, samples);
            const Look none = look(view, MipMode::none, integrator, samples);
            EXPECT_NEAR(mips.mean, 0.5, 0.005);
            EXPECT_LT(mips.deviation, deviation_of_grey);
            EXPECT_GT(none.deviation, 0.4 / std::sqrt(samples)) << "the bound tells nothing";
            EXPECT_NEAR(none.mean, 0.5, 0.05) << "the film does not show the board alone";
        }
    }
}

constexpr int line_side = 512;  ///< texels: 16 for a pixel
constexpr int line_pixel = 11;

/// A white card that fills the film, with a black line over one column of pixels.
Film line_image(int samples) {
    SceneBuilder builder;
    Material m;
    m.flags = material_unlit;
    m.base_color_texture.texture = 0;
    builder.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, builder.material(m));
    Scene scene = builder.take();
    constexpr int texels = line_side / film_side;
    add_image(scene.textures,
              line_side,
              pack_sampler(Wrap::clamp, Wrap::clamp, false, false, MipMode::linear, true),
              [](int x, int) { return x / texels == line_pixel ? black_texel : white_texel; });
    scene.primitives[0].uv_base[0] = 0;
    scene.attributes = {0, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0};
    RenderOptions options;
    options.width = options.height = film_side;
    options.samples_per_pixel = samples;
    const Camera camera = look_at({0, 0, 10}, {0, 0, 0}, 2 * std::atan(0.1f), film_side, film_side);
    return render_scene(std::move(scene), {}, camera, options).film;
}

/// Over a column's rows.
Look column(const Film& film, int x) {
    double sum = 0, squares = 0;
    for (int y = 0; y < film_side; ++y) {
        const auto at = static_cast<size_t>(y * film_side + x) * film.channels.size();
        const auto v = static_cast<double>(film.pixels[at]);
        sum += v / film_side;
        squares += v * v / film_side;
    }
    return {sum, std::sqrt(std::max(squares - sum * sum, 0.0))};
}

/// The pixels see white, black, white. A look-up that covers 1/n of the pixel's width and then
/// takes a tent of that width's texels mixes 1/8n of it over each edge.
TEST(Footprint, ALineOnePixelWideIsSharperTheMoreSamplesThereAre) {
    for (const auto& [samples, share] :
         {std::pair{1, 1.0}, {4, 0.5}, {16, 0.25}, {64, 0.125}, {1024, 0.125}}) {
        SCOPED_TRACE(testing::Message() << samples << " spp");
        const Film film = line_image(samples);
        const double mixed = share / 8;
        const double error = 3 * 0.5 * std::sqrt(mixed / (samples * film_side));
        EXPECT_NEAR(column(film, line_pixel).mean, 2 * mixed, 2 * error);
        EXPECT_NEAR(column(film, line_pixel - 1).mean, 1 - mixed, 2 * error);
        EXPECT_NEAR(column(film, line_pixel + 1).mean, 1 - mixed, 2 * error);
        // It is also no noisier than independent samples of a whole pixel's footprint would be.
        EXPECT_LT(column(film, line_pixel).deviation, std::sqrt(0.25 * 0.75 / samples) + 0.05);
        EXPECT_EQ(column(film, line_pixel + 3).mean, 1);
    }
}

}  // namespace footprint_truth
}  // namespace obscura::test
