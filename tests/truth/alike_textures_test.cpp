// tests/truth/alike_textures_test.cpp - textures looked up together equal those looked up alone.
// SPDX-License-Identifier: Apache-2.0
#include "scene/alike_textures.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include "support/scene_builder.h"
#include "truth/reference.h"

namespace obscura::test {
namespace alike_textures_truth {

constexpr int image_side = 16;

/// Adds an image of noise. `gap`: unused texels before its levels 1 and up.
int32_t add_noise(TextureArena& arena, uint64_t seed, bool srgb, int32_t gap) {
    Pcg32 random(seed);
    std::vector<uint32_t> texels(mip_chain_texels(image_side, image_side));
    for (int i = 0; i < image_side * image_side; ++i)
        texels[static_cast<size_t>(i)] = random.next_uint() | 0xFF000000U;
    build_mip_chain(texels.data(), image_side, image_side, srgb);
    TextureRecord record;
    record.width = record.height = image_side;
    record.levels = mip_level_count(image_side, image_side);
    record.sampler = pack_sampler(Wrap::repeat, Wrap::mirror, false, false, MipMode::linear, srgb);
    auto at = static_cast<int32_t>(arena.texels.size());
    const auto base_end = texels.begin() + image_side * image_side;
    arena.texels.insert(arena.texels.end(), texels.begin(), base_end);
    arena.texels.insert(arena.texels.end(), static_cast<size_t>(gap), 0xFF00FF00U);
    arena.texels.insert(arena.texels.end(), base_end, texels.end());
    for (int level = 0; level < record.levels; ++level) {
        record.level_offset[level] = at + (level > 0 ? gap : 0);
        at += (image_side >> level) * (image_side >> level);
    }
    arena.records.push_back(record);
    return static_cast<int32_t>(arena.records.size()) - 1;
}

/// A slanted floor with base colour and roughness; with a gap the two are not alike.
Scene textured_floor(int32_t gap) {
    SceneBuilder builder;
    Material m;
    m.metallic = 0.5f;
    m.base_color_texture.texture = 0;
    m.base_color_texture.uv_from_mesh[2] = 0.3f;
    m.metallic_roughness_texture = m.base_color_texture;
    m.metallic_roughness_texture.texture = 1;
    builder.quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, builder.material(m));
    Scene scene = builder.take();
    add_noise(scene.textures, 1, true, 0);
    add_noise(scene.textures, 2, false, gap);
    scene.primitives[0].uv_base[0] = 0;
    scene.attributes = {0, 0, 5, 0, 5, 5, 0, 5};
    scene.attributes.insert(scene.attributes.end(), 4, 0.0f);
    return scene;
}

Film image(int32_t gap) {
    RenderOptions options;
    options.width = options.height = 48;
    options.samples_per_pixel = 4;
    const std::vector<std::string> names = {
        "base_color", "roughness", "metallic", "albedo", "facing"};
    options.layers = layers_of(names, 2).value();
    const Camera camera = look_at({0.2f, 1, 3}, {0, 0, 0}, 0.9f, 48, 48);
    Scene scene = textured_floor(gap);
    mark_alike_textures(scene);
    return std::move(render_scene(std::move(scene), {}, camera, options).film);
}

TEST(AlikeTextures, ImagesAreTheSameTogetherAndAlone) {
    const Film together = image(0);
    const Film alone = image(5);
    EXPECT_EQ(together.pixels, alone.pixels);
    EXPECT_GT(*std::max_element(together.pixels.begin(), together.pixels.end()), 0.1f);
    for (size_t k = 0; k < together.layers.size(); ++k) {
        const UnsetArray<float>& pixels = together.layers[k].pixels;
        const std::string& name = together.layers[k].layer.name;
        EXPECT_EQ(pixels, alone.layers[k].pixels) << name;
        EXPECT_GT(*std::max_element(pixels.begin(), pixels.end()), 0.1f) << name;
    }
}

TEST(AlikeTextures, SameLayoutAndCoordinatesAreMarked) {
    Scene alike = textured_floor(0);
    mark_alike_textures(alike);
    EXPECT_NE(alike.materials[0].flags & material_textures_alike, 0U);
    EXPECT_EQ(alike.materials[0].normal_texture.texture, -1);
    EXPECT_EQ(alike.materials[0].normal_texture.uv_from_mesh[2], 0.3f);

    Scene gap = textured_floor(5);
    Scene moved = textured_floor(0);
    moved.materials[0].metallic_roughness_texture.uv_from_mesh[5] = 0.5f;
    Scene clamped = textured_floor(0);
    clamped.textures.records[1].sampler ^= 1U;
    Scene bare = textured_floor(0);
    bare.materials[0].base_color_texture.texture = -1;
    bare.materials[0].metallic_roughness_texture.texture = -1;
    for (Scene* scene : {&gap, &moved, &clamped, &bare}) {
        mark_alike_textures(*scene);
        EXPECT_EQ(scene->materials[0].flags & material_textures_alike, 0U);
    }
}

}  // namespace alike_textures_truth
}  // namespace obscura::test
