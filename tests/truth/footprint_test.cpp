// tests/truth/footprint_test.cpp - mip levels follow the footprint: distant chequers are grey.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/scene_builder.h"
#include "truth/reference.h"

namespace obscura::test {
namespace {

constexpr int picture_side = 64;  ///< texels; squares of 8: from level 4 on all is grey
constexpr int film_side = 32;
constexpr double deviation_of_grey = 0.02;

/// A chequer board of black and white squares with its mip chain.
TextureArena chequer_board(MipMode mip) {
    TextureArena arena;
    arena.texels.resize(mip_chain_texels(picture_side, picture_side));
    for (int y = 0; y < picture_side; ++y) {
        for (int x = 0; x < picture_side; ++x) {
            const bool white = ((x >> 3) + (y >> 3)) % 2 == 0;
            arena.texels[static_cast<size_t>(y * picture_side + x)] =
                white ? 0xFFFFFFFFU : 0xFF000000U;
        }
    }
    build_mip_chain(arena.texels.data(), picture_side, picture_side, true);
    TextureRow row;
    row.width = row.height = picture_side;
    row.levels = mip_level_count(picture_side, picture_side);
    row.sampler = pack_sampler(Wrap::repeat, Wrap::repeat, false, false, mip, true);
    int32_t at = 0;
    for (int level = 0; level < row.levels; ++level) {
        row.level_offset[level] = at;
        at += (picture_side >> level) * (picture_side >> level);
    }
    arena.rows = {row};
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
/// slant: tiles are so small that it covers a grey texel, and without the slant it would not.
struct View {
    float distance_m, yfov_rad, tiles_per_m;
};

/// Over the pixels of a film.
struct Look {
    double mean, deviation;
};

Look look(const View& view, MipMode mip, Integrator integrator, int samples) {
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
                                                  std::pair{Integrator::path, 4}}) {
            SCOPED_TRACE(testing::Message() << view.distance_m << " m, " << samples << " spp");
            const Look mips = look(view, MipMode::linear, integrator, samples);
            const Look none = look(view, MipMode::none, integrator, samples);
            EXPECT_NEAR(mips.mean, 0.5, 0.005);
            EXPECT_LT(mips.deviation, deviation_of_grey);
            EXPECT_GT(none.deviation, 10 * deviation_of_grey) << "the bound tells nothing";
            EXPECT_NEAR(none.mean, 0.5, 0.05) << "the film does not show the board alone";
        }
    }
}

}  // namespace
}  // namespace obscura::test
