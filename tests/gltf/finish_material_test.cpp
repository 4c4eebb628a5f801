// tests/gltf/finish_material_test.cpp - the material extensions' factors, textures and numbers.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/finish_material.h"

#include "gltf/gltf_files.h"
#include "gltf/images.h"
#include "scene/media.h"

#include <gtest/gtest.h>

#include <gmock/gmock.h>

namespace obscura::gltf {
namespace {

using namespace test;

/// The triangle with one material that has these extensions; texture 0 is an image.
Loaded load_with(const json& extensions) {
    json tree = triangle_asset();
    tree["materials"][0]["extensions"] = extensions;
    tree["meshes"][0]["primitives"][0]["material"] = 0;
    tree["textures"][0]["source"] = 0;
    tree["images"][0]["uri"] = png_uri(2, 2);
    return load_tree(tree);
}

MaterialLayers layers_of(const json& extensions) {
    const Loaded loaded = load_with(extensions);
    EXPECT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.scene->layers.size(), 1U);
    return loaded.scene->layers.at(0);
}

TEST(MaterialExtensions, NoneNeedNoLayers) {
    const Loaded loaded = load_with(json::object());
    ASSERT_TRUE(loaded.scene);
    EXPECT_TRUE(loaded.scene->layers.empty());
    EXPECT_EQ(loaded.scene->media.size(), 1U);
}

TEST(MaterialExtensions, EmptyOnesMeanTheirDefaults) {
    const MaterialLayers all = layers_of(json::parse(R"({
        "KHR_materials_anisotropy": {}, "KHR_materials_clearcoat": {},
        "KHR_materials_diffuse_transmission": {}, "KHR_materials_dispersion": {},
        "KHR_materials_ior": {}, "KHR_materials_iridescence": {}, "KHR_materials_sheen": {},
        "KHR_materials_specular": {}, "KHR_materials_transmission": {},
        "KHR_materials_volume": {}})"));
    EXPECT_EQ(all.ior, 1.5F);
    EXPECT_EQ(all.specular, 1.0F);
    EXPECT_THAT(all.specular_color, testing::Each(1.0F));
    EXPECT_EQ(all.clearcoat, 0.0F);
    EXPECT_THAT(all.sheen_color, testing::Each(0.0F));
    EXPECT_EQ(all.anisotropy, 0.0F);
    EXPECT_EQ(all.iridescence, 0.0F);
    EXPECT_EQ(all.iridescence_ior, 1.3F);
    EXPECT_THAT(all.thin_film_thickness_nm, testing::ElementsAre(100.0F, 400.0F));
    EXPECT_EQ(all.transmission, 0.0F);
    EXPECT_THAT(all.attenuation, testing::Each(0.0F));
    EXPECT_EQ(all.medium, 0);
}

TEST(MaterialExtensions, FactorsAreRead) {
    const MaterialLayers glass = layers_of(json::parse(R"({
        "KHR_materials_ior": {"ior": 1.33},
        "KHR_materials_transmission": {"transmissionFactor": 0.75},
        "KHR_materials_dispersion": {"dispersion": 0.5},
        "KHR_materials_volume": {"thicknessFactor": 0.1, "attenuationDistance": 2,
                                 "attenuationColor": [0.5, 1, 0.25]}})"));
    EXPECT_EQ(glass.ior, 1.33F);
    EXPECT_EQ(glass.transmission, 0.75F);
    EXPECT_EQ(glass.dispersion, 0.5F);
    EXPECT_NEAR(glass.attenuation[0], std::log(2.0) / 2, 1e-6);
    EXPECT_EQ(glass.attenuation[1], 0.0F);
    EXPECT_NEAR(glass.attenuation[2], std::log(4.0) / 2, 1e-6);
    EXPECT_EQ(glass.medium, 1);
    const MaterialLayers brushed = layers_of(json::parse(R"({
        "KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "anisotropyRotation": 1.5707963},
        "KHR_materials_sheen": {"sheenColorFactor": [1, 0.5, 0.25],
                                "sheenRoughnessFactor": 0.4}})"));
    EXPECT_NEAR(brushed.anisotropy_cosine, 0, 1e-6);
    EXPECT_NEAR(brushed.anisotropy_sine, 1, 1e-6);
    EXPECT_THAT(brushed.sheen_color, testing::ElementsAre(1.0F, 0.5F, 0.25F));
    EXPECT_EQ(brushed.sheen_roughness, 0.4F);
}

TEST(MaterialExtensions, TexturesHaveTheColourSpaceOfTheirSlot) {
    const json texture = {{"index", 0}};
    const Loaded loaded = load_with({{"KHR_materials_clearcoat", {{"clearcoatTexture", texture}}},
                                     {"KHR_materials_sheen", {{"sheenColorTexture", texture}}}});
    ASSERT_TRUE(loaded.scene) << loaded.text();
    const MaterialLayers& layers = loaded.scene->layers.at(0);
    const auto record = [&](const TextureSlot& slot) {
        return loaded.scene->textures.records.at(static_cast<size_t>(slot.texture));
    };
    EXPECT_EQ(record(layers.clearcoat_texture).sampler & sampler_srgb, 0U);
    EXPECT_NE(record(layers.sheen_color_texture).sampler & sampler_srgb, 0U);
    EXPECT_EQ(layers.iridescence_texture.texture, -1);
}

TEST(MaterialExtensions, NumbersOutOfRangeAreClampedWithAWarning) {
    const Loaded loaded =
        load_with(json::parse(R"({"KHR_materials_transmission": {"transmissionFactor": 3}})"));
    ASSERT_TRUE(loaded.scene);
    EXPECT_EQ(loaded.scene->layers.at(0).transmission, 1.0F);
    EXPECT_THAT(loaded.warnings, testing::HasSubstr("transmissionFactor"));
}

TEST(Media, TheDenserMediumHasTheGreaterNumber) {
    Scene scene;
    for (const float ior : {1.5F, 1.33F, 2.4F, 1.0F}) {
        MaterialLayers layers;
        layers.ior = ior;
        layers.medium = ior > 1.0F ? 1 : 0;
        scene.layers.push_back(layers);
    }
    number_media(scene);
    ASSERT_EQ(scene.media.size(), 4U);
    EXPECT_EQ(scene.layers[0].medium, 2);
    EXPECT_EQ(scene.layers[1].medium, 1);
    EXPECT_EQ(scene.layers[2].medium, 3);
    EXPECT_EQ(scene.layers[3].medium, 0);
    EXPECT_EQ(scene.media[3].ior, 2.4F);
}

}  // namespace
}  // namespace obscura::gltf
