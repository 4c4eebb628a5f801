// tests/gltf/materials_test.cpp - factors, flags, texture slots and the resulting materials.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/materials/materials.h"

#include "gltf/gltf_files.h"
#include "gltf/images.h"

#include <gtest/gtest.h>

#include <gmock/gmock.h>
#include <numbers>

namespace obscura::gltf {
namespace {

using namespace test;

/// The triangle with one material; texture 0 is an image of 2 x 2.
json textured_triangle(const json& material) {
    json tree = triangle_asset();
    tree["materials"][0] = material;
    tree["meshes"][0]["primitives"][0]["material"] = 0;
    tree["textures"][0]["source"] = 0;
    tree["images"][0]["uri"] = png_uri(2, 2);
    return tree;
}

/// The loaded material of the triangle.
Material material_of(const json& material, std::string* warnings = nullptr) {
    const Loaded loaded = load_tree(textured_triangle(material));
    EXPECT_TRUE(loaded.scene) << loaded.text();
    if (warnings != nullptr) *warnings = loaded.warnings;
    if (!loaded.scene) return {};
    return loaded.scene->materials[static_cast<size_t>(loaded.scene->primitives[0].material)];
}

json base_texture(const json& extra = json::object()) {
    json material;
    material["pbrMetallicRoughness"]["baseColorTexture"] = extra;
    material["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
    return material;
}

TEST(Materials, DefaultsAreThoseOfGltf) {
    const Material material = material_of(json::object());
    EXPECT_THAT(material.base_color, testing::Each(1.0f));
    EXPECT_EQ(material.metallic, 1);
    EXPECT_EQ(material.roughness, 1);
    EXPECT_EQ(material.alpha_cutoff, 0.5f);
    EXPECT_THAT(material.emission, testing::Each(0.0f));
    EXPECT_EQ(material.flags, 0U);
    const MaterialLayers layers;
    for (size_t slot = 0; slot < slot_count; ++slot)
        EXPECT_EQ(slot_of(slot, material, layers)->texture, -1);
    EXPECT_EQ(material.layers, -1);
}

TEST(Materials, FactorsAndFlags) {
    const Material material = material_of(json::parse(R"({
        "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4],
                                 "metallicFactor": 0.5, "roughnessFactor": 0.6},
        "emissiveFactor": [0.5, 0.25, 1], "alphaMode": "MASK", "alphaCutoff": 0.7,
        "doubleSided": true, "normalTexture": {"index": 0, "scale": -2},
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 8}}})"));
    EXPECT_THAT(material.base_color, testing::ElementsAre(0.1f, 0.2f, 0.3f, 0.4f));
    EXPECT_EQ(material.metallic, 0.5f);
    EXPECT_EQ(material.roughness, 0.6f);
    EXPECT_THAT(material.emission, testing::ElementsAre(4, 2, 8));
    EXPECT_EQ(material.alpha_cutoff, 0.7f);
    EXPECT_EQ(material.normal_scale, -2);
    EXPECT_EQ(material.flags, material_alpha_mask | material_double_sided);
    EXPECT_EQ(material_of({{"alphaMode", "BLEND"}}).flags, material_alpha_blend);
    json solid = json::parse(R"({
        "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
                       "KHR_materials_volume": {"thicknessFactor": 1}}})");
    EXPECT_EQ(material_of(solid).flags, material_double_sided | material_glows_in_front);
    solid["doubleSided"] = true;
    EXPECT_EQ(material_of(solid).flags, material_double_sided);
    const Material unlit = material_of(json::parse(R"({
        "emissiveFactor": [0.5, 0.25, 1], "extensions": {"KHR_materials_unlit": {}}})"));
    EXPECT_EQ(unlit.flags, material_unlit);
    EXPECT_THAT(unlit.emission, testing::ElementsAre(0, 0, 0)) << "the base colour is all";
}

TEST(Materials, FactorsOutOfRangeAreClamped) {  // F3, F13
    std::string warnings;
    const Material material = material_of(json::parse(R"({
        "pbrMetallicRoughness": {"baseColorFactor": [-1, 2, 0.5, 1e30],
                                 "metallicFactor": -3, "roughnessFactor": 1e300},
        "emissiveFactor": [2, 0, -1],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 1e300}}})"),
                                          &warnings);
    EXPECT_THAT(material.base_color, testing::ElementsAre(0, 1, 0.5f, 1));
    EXPECT_EQ(material.metallic, 0);
    EXPECT_EQ(material.roughness, 1);
    EXPECT_THAT(material.emission, testing::ElementsAre(1e20f, 0, 0));
    for (const char* name : {"baseColorFactor",
                             "metallicFactor",
                             "roughnessFactor",
                             "emissiveFactor",
                             "emissiveStrength"}) {
        EXPECT_NE(warnings.find(name), std::string::npos) << warnings;
    }
}

/// The matrix that a KHR_texture_transform gives.
std::vector<float> matrix_of(const json& transform) {
    json extra;
    extra["extensions"]["KHR_texture_transform"] = transform;
    const Material material = material_of(base_texture(extra));
    const float* m = material.base_color_texture.uv_from_mesh;
    return {m, m + 6};
}

TEST(Materials, TextureTransforms) {
    using testing::FloatNear;
    using testing::Pointwise;
    using F = std::vector<float>;
    EXPECT_EQ(matrix_of({{"offset", {0.25, -3}}}), (F{1, 0, 0.25f, 0, 1, -3}));
    EXPECT_EQ(matrix_of({{"scale", {2, -1}}, {"offset", {0, 1}}}), (F{2, 0, 0, 0, -1, 1}));
    // The extension's own example: "the lower left quadrant, rotated clockwise".
    EXPECT_THAT(
        matrix_of({{"offset", {0, 1}}, {"rotation", std::numbers::pi / 2}, {"scale", {0.5, 0.5}}}),
        Pointwise(FloatNear(1e-6f), F{0, 0.5f, 0, -0.5f, 0, 1}));
    // Scale comes first, in the axes of the mesh.
    EXPECT_THAT(matrix_of({{"rotation", std::numbers::pi / 2}, {"scale", {3, 5}}}),
                Pointwise(FloatNear(1e-6f), F{0, 5, 0, -3, 0, 0}));
}

TEST(Materials, TheTransformMayChooseTheUvSet) {
    json tree = textured_triangle(json::parse(R"({"pbrMetallicRoughness": {"baseColorTexture":
        {"index": 0, "texCoord": 3, "extensions": {"KHR_texture_transform": {"texCoord": 7}}}}})"));
    tree["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_7"] = 2;
    const Loaded loaded = load_tree(tree);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.warnings, "");
    EXPECT_EQ(loaded.scene->materials[1].base_color_texture.uv_set, 7);
    const Primitive& primitive = loaded.scene->primitives[0];
    EXPECT_EQ(primitive.uv_base[0], no_attribute);  // nobody looks at it
    EXPECT_EQ(attribute_of(*loaded.scene, primitive.uv_base[7], 1, 2), (std::vector<float>{1, 1}));
}

TEST(Materials, UvSetsBeyondSevenAre65OrIgnored) {
    const auto by_transform = [](uint64_t set) {
        return json{{"extensions", {{"KHR_texture_transform", {{"texCoord", set}}}}}};
    };
    for (const uint64_t set : {uint64_t{8}, uint64_t{1} << 31, uint64_t{1} << 50}) {
        for (const json& info : {json{{"texCoord", set}}, by_transform(set)}) {
            const json tree = textured_triangle(base_texture(info));
            const Loaded strict = load_tree(tree);
            EXPECT_EQ(strict.id(), "E-MAT-TEXCOORD");
            EXPECT_THAT(strict.text(),
                        testing::AnyOf(testing::HasSubstr("texCoord is " + std::to_string(set)),
                                       testing::HasSubstr("texCoord is 2147483647 or more")));
            EXPECT_NE(strict.text().find("largest that is read is 7"), std::string::npos);
            LoadOptions options;
            options.lenient = true;
            const Loaded lenient = load_tree(tree, options);
            ASSERT_TRUE(lenient.scene) << lenient.text();
            EXPECT_EQ(lenient.scene->materials[1].base_color_texture.texture, -1);
            EXPECT_TRUE(lenient.warns("the texture is ignored")) << lenient.warnings;
        }
    }
}

/// One material on two primitives, of which one lacks the UV set of a slot: it gets a copy.
TEST(Materials, MissingUvSetsMakeReducedCopies) {  // F5
    json material = base_texture();
    material["emissiveTexture"] = {{"index", 0}, {"texCoord", 1}};
    material["name"] = "Cloth";
    json tree = textured_triangle(material);
    json& primitives = tree["meshes"][0]["primitives"];
    primitives.push_back(primitives[0]);
    primitives[0]["attributes"]["TEXCOORD_1"] = 2;
    primitives.push_back(primitives[1]);
    EXPECT_EQ(load_tree(tree).id(), "E-MESH-TEXCOORD");
    LoadOptions lenient;
    lenient.lenient = true;
    const Loaded loaded = load_tree(tree, lenient);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    const Scene& scene = *loaded.scene;
    ASSERT_EQ(scene.materials.size(), 3U);
    EXPECT_EQ(scene.material_names,
              (std::vector<std::string>{"default material", "Cloth", "Cloth"}));
    EXPECT_EQ(scene.primitives[0].material, 1);
    EXPECT_EQ(scene.primitives[1].material, 2);
    EXPECT_EQ(scene.primitives[2].material, 2);
    EXPECT_GE(scene.materials[1].emissive_texture.texture, 0);
    EXPECT_EQ(scene.materials[2].emissive_texture.texture, -1);
    EXPECT_GE(scene.materials[2].base_color_texture.texture, 0);
    EXPECT_TRUE(loaded.warns("absent: emissiveTexture (TEXCOORD_1)")) << loaded.warnings;
}

TEST(Materials, PrimitivesWithoutOneTakeRecordZero) {
    json tree = textured_triangle(base_texture());
    tree["meshes"][0]["primitives"][0].erase("material");
    const Loaded loaded = load_tree(tree);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.scene->primitives[0].material, 0);
    // Nothing drawn uses the texture: the slot is empty and no texel was decoded.
    EXPECT_EQ(loaded.scene->materials[1].base_color_texture.texture, -1);
    EXPECT_TRUE(loaded.scene->textures.texels.empty());
    EXPECT_TRUE(loaded.scene->info.images[0].used_as_color);
    EXPECT_EQ(loaded.scene->info.images[0].width, 2);
}

}  // namespace
}  // namespace obscura::gltf
