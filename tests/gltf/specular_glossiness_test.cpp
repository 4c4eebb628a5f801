// tests/gltf/specular_glossiness_test.cpp - specular-glossiness materials become metal-roughness.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/specular_glossiness.h"

#include "gltf/gltf_files.h"
#include "gltf/images.h"

#include <gtest/gtest.h>

namespace obscura::gltf {
namespace {

using namespace test;

/// An image of one texel as a data URI.
std::string texel_uri(unsigned r, unsigned g, unsigned b, unsigned a) {
    const auto bytes = testing_images::PngBuilder(1, 1, 8, 6).finish({{r, g, b, a}});
    return "data:image/png;base64," +
           base64({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

/// The triangle with one material; its two images are textures 0 and 1.
Loaded load_with(const json& extension, const json& more = json::object()) {
    json tree = triangle_asset();
    tree["materials"][0] = more;
    tree["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"] = extension;
    json& primitive = tree["meshes"][0]["primitives"][0];
    primitive["material"] = 0;
    tree["textures"] = {{{"source", 0}}, {{"source", 1}}};
    tree["images"] = {{{"uri", texel_uri(10, 20, 30, 255)}}, {{"uri", texel_uri(40, 50, 60, 102)}}};
    tree["accessors"].push_back({{"componentType", 5126}, {"count", 3}, {"type", "VEC2"}});
    primitive["attributes"]["TEXCOORD_0"] = tree["accessors"].size() - 1;
    return load_tree(tree);
}

TEST(SpecularGlossiness, FactorsBecomeADielectricWithThatReflectance) {
    const Loaded loaded = load_with({{"diffuseFactor", {0.1, 0.2, 0.3, 0.4}},
                                     {"specularFactor", {0.5, 0.6, 0.7}},
                                     {"glossinessFactor", 0.75}});
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.warnings, "");
    const Material& m = loaded.scene->materials.at(1);
    EXPECT_EQ(m.base_color[0], 0.1F);
    EXPECT_EQ(m.base_color[3], 0.4F);
    EXPECT_EQ(m.metallic, 0);
    EXPECT_EQ(m.roughness, 0.25F);
    ASSERT_EQ(loaded.scene->layers.size(), 1U);
    const MaterialLayers& layers = loaded.scene->layers[0];
    EXPECT_EQ(layers.ior, 0) << "all is reflected, times the colour";
    EXPECT_EQ(layers.specular, 1);
    EXPECT_EQ(layers.specular_color[1], 0.6F);
}

TEST(SpecularGlossiness, NothingGivenIsAWhiteMirror) {
    const Loaded loaded = load_with(json::object(), {{"pbrMetallicRoughness", json::object()}});
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.scene->materials[1].roughness, 0);
    EXPECT_EQ(loaded.scene->materials[1].base_color[2], 1);
    EXPECT_EQ(loaded.scene->layers[0].specular_color[2], 1);
}

TEST(SpecularGlossiness, TexturesBecomeColourAndRoughness) {
    const Loaded loaded = load_with({{"glossinessFactor", 0.5},
                                     {"diffuseTexture", {{"index", 0}}},
                                     {"specularGlossinessTexture", {{"index", 1}}}});
    ASSERT_TRUE(loaded.scene) << loaded.text();
    const Scene& scene = *loaded.scene;
    const auto texel = [&](const TextureSlot& slot) {
        EXPECT_GE(slot.texture, 0);
        const TextureRecord& record = scene.textures.records.at(static_cast<size_t>(slot.texture));
        return scene.textures.texels.at(static_cast<size_t>(record.level_offset[0]));
    };
    const Material& m = scene.materials.at(1);
    EXPECT_EQ(texel(m.base_color_texture), 0xFF1E140AU);
    EXPECT_EQ(texel(scene.layers.at(0).specular_color_texture), 0x663C3228U);
    EXPECT_EQ(texel(m.metallic_roughness_texture) >> 8 & 255U, 255U - 51U) << "1 - 0.5 * 0.4";
    EXPECT_EQ(m.roughness, 1);
    ASSERT_EQ(scene.info.images.size(), 3U);
    EXPECT_EQ(scene.info.images[2].name, "image 1, as roughness");
    EXPECT_TRUE(scene.info.images[2].used_as_data);
    EXPECT_FALSE(scene.info.images[1].used_as_data);
}

TEST(SpecularGlossiness, UnlitMaterialsKeepTheCoresColour) {
    json more;
    more["pbrMetallicRoughness"]["baseColorFactor"] = {1, 0, 0, 1};
    more["extensions"]["KHR_materials_unlit"] = json::object();
    const Loaded loaded = load_with({{"diffuseFactor", {0, 1, 0, 1}}}, more);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.scene->materials[1].base_color[0], 1);
}

TEST(SpecularGlossiness, RoughnessIsOneMinusGlossiness) {
    std::vector<uint32_t> texels = {0x00FFFFFFU, 0xFF000000U, 0x80123456U};
    roughness_from_glossiness(texels, {}, 1);
    EXPECT_EQ(texels[0] >> 8 & 255U, 255U);
    EXPECT_EQ(texels[1] >> 8 & 255U, 0U);
    EXPECT_EQ(texels[2] >> 8 & 255U, 127U);

    std::vector<uint32_t> high = {0x12FFFFFFU}, low = {0x34000000U};
    roughness_from_glossiness(high, low, 1);
    EXPECT_EQ((high[0] >> 8 & 255U) << 8 | (low[0] >> 8 & 255U), 0xFFFFU - 0x1234U);
}

}  // namespace
}  // namespace obscura::gltf
