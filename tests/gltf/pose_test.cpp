// tests/gltf/pose_test.cpp - animations change nodes, materials, lights and cameras.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/pose.h"

#include "gltf/animated_files.h"
#include "gltf/images.h"

#include <gtest/gtest.h>

#include <cmath>
#include <gmock/gmock.h>

namespace obscura::gltf {
namespace {

using namespace test;
using testing::FloatNear;
using testing::Pointwise;
using F = std::vector<float>;

/// A triangle that moves 4 m along x in 2 s.
AssetBuilder moving_triangle() {
    AssetBuilder builder = triangle_builder();
    add_animation(
        builder, "Slide", {{node_target(0, "translation"), {0, 2}, "VEC3", {0, 0, 0, 4, 0, 0}}});
    return builder;
}

float left_of(const Loaded& loaded) {
    return loaded.scene ? loaded.scene->bounds.low.x : NAN;
}

TEST(Pose, ATimePlaysTheFirstAnimation) {
    AssetBuilder builder = moving_triangle();
    add_animation(builder, "Lift", {{node_target(0, "translation"), {0}, "VEC3", {-9, 0, 0}}});
    const json tree = builder.finished();
    EXPECT_EQ(left_of(load_tree(tree)), 0.0F) << "as stored";
    const Loaded still = load_tree(tree);
    EXPECT_EQ(still.warnings, "");
    EXPECT_FALSE(still.scene->info.time_s);
    EXPECT_EQ(left_of(load_at(tree, 0.5)), 1.0F);
    EXPECT_EQ(load_at(tree, 0.5).scene->info.time_s, 0.5);
    EXPECT_EQ(left_of(load_at(tree, 1.5, "Slide")), 3.0F);
    EXPECT_EQ(left_of(load_at(tree, 0.5, "1")), -9.0F);
    EXPECT_EQ(left_of(load_at(tree, 0.5, "all")), -9.0F) << "the later one counts";
    EXPECT_EQ(left_of(load_at(tree, 0.5, "none")), 0.0F);
    LoadOptions options;
    options.animation = "Lift";
    EXPECT_EQ(left_of(load_tree(tree, options)), -9.0F) << "at 0";
}

TEST(Pose, UnknownAnimationsAreRefusedWithTheirNames) {
    AssetBuilder builder = moving_triangle();
    builder.tree["animations"].push_back(builder.tree["animations"][0]);
    const json tree = builder.finished();
    EXPECT_EQ(load_at(tree, 0, "Slide").id(), "E-ANIM-AMBIGUOUS");
    const Loaded unknown = load_at(tree, 0, "Jump");
    EXPECT_EQ(unknown.code(), 64);
    EXPECT_EQ(unknown.id(), "E-ANIM-UNKNOWN");
    EXPECT_THAT(unknown.text(), testing::HasSubstr("0 \"Slide\", 1 \"Slide\""));
    EXPECT_EQ(load_at(tree, 0, "2").id(), "E-ANIM-UNKNOWN");
    const Loaded none = load_at(triangle_asset(), 3);
    ASSERT_TRUE(none.scene);
    EXPECT_TRUE(none.warns("the asset has no animation"));
}

/// A vertex of the only instance: what an animated node moves is one.
F placed_position(const Scene& scene, uint32_t vertex) {
    if (scene.instances.size() != 1) return {};
    const F p = position_of(scene, vertex);
    const Vec3f v = transform_point(scene.instances[0].world_from_object, Vec3f{p[0], p[1], p[2]});
    return {v.x, v.y, v.z};
}

TEST(Pose, RotationAndScaleReachTheWorld) {
    AssetBuilder builder = triangle_builder();
    const float half = std::sqrt(0.5F);
    add_animation(builder,
                  "Turn",
                  {{node_target(0, "rotation"), {0, 1}, "VEC4", {0, 0, 0, 1, 0, 0, half, half}},
                   {node_target(0, "scale"), {0, 1}, "VEC3", {1, 1, 1, 3, 1, 1}}});
    const Loaded loaded = load_at(builder.finished(), 0.5);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    // (2, 0, 0) is doubled, then turned by 45 degrees.
    const float root = 4 * half;
    EXPECT_THAT(placed_position(*loaded.scene, 1), Pointwise(FloatNear(1e-6F), F{root, root, 0}));
}

TEST(Pose, ParentsCarryTheirChildren) {
    AssetBuilder builder = moving_triangle();
    builder.tree["nodes"] = {{{"children", {1}}}, {{"mesh", 0}, {"translation", {0, 5, 0}}}};
    const Loaded loaded = load_at(builder.finished(), 2);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(placed_position(*loaded.scene, 0), (F{4, 5, 0}));
}

TEST(Pose, VisibilityIsSwitched) {
    AssetBuilder builder = triangle_builder();
    builder.add_root({{"mesh", 0}, {"translation", {0, 0, 9}}});
    add_animation(builder,
                  "Blink",
                  {{pointer_target("/nodes/0/extensions/KHR_node_visibility/visible"),
                    {0, 1},
                    "SCALAR",
                    {1, 0},
                    "STEP"}});
    const json tree = builder.finished();
    EXPECT_EQ(load_at(tree, 0.5).scene->info.triangles_in_world, 2U);
    EXPECT_EQ(load_at(tree, 1).scene->info.triangles_in_world, 1U);
}

/// A textured, lit triangle with a camera, to be changed through pointers.
AssetBuilder pointed_asset() {
    AssetBuilder builder = triangle_builder();
    builder.tree["images"][0]["uri"] = png_uri(1, 1);
    builder.tree["textures"][0]["source"] = 0;
    builder.tree["materials"][0] = {
        {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
        {"emissiveFactor", {1, 1, 1}}};
    builder.tree["meshes"][0]["primitives"][0]["material"] = 0;
    builder.tree["extensions"]["KHR_lights_punctual"]["lights"][0] = {{"type", "point"}};
    builder.add_root({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    builder.tree["cameras"][0] = {{"type", "perspective"},
                                  {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}};
    builder.add_root({{"camera", 0}});
    return builder;
}

TEST(Pose, PointersReachMaterialsLightsAndCameras) {
    AssetBuilder builder = pointed_asset();
    const std::string material = "/materials/0/extensions/";
    const std::string strength = material + "KHR_materials_emissive_strength/emissiveStrength";
    const std::string coat = material + "KHR_materials_clearcoat/clearcoatFactor";
    add_animation(builder,
                  "All",
                  {{pointer_target("/materials/0/pbrMetallicRoughness/baseColorFactor"),
                    {0, 1},
                    "VEC4",
                    {0, 0, 0, 1, 1, 0.5F, 0, 1}},
                   {pointer_target(strength.c_str()), {0, 1}, "SCALAR", {0, 20}},
                   {pointer_target(coat.c_str()), {0, 1}, "SCALAR", {0, 1}},
                   {pointer_target("/extensions/KHR_lights_punctual/lights/0/intensity"),
                    {0, 1},
                    "SCALAR",
                    {0, 6}},
                   {pointer_target("/cameras/0/perspective/yfov"), {0, 1}, "SCALAR", {1, 2}}});
    const Loaded loaded = load_at(builder.finished(), 0.5);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.warnings, "");
    const Scene& scene = *loaded.scene;
    const Material& got = scene.materials[1];
    EXPECT_EQ(F(got.base_color, got.base_color + 4), (F{0.5F, 0.25F, 0, 1}));
    EXPECT_EQ(got.emission[0], 10.0F);
    ASSERT_EQ(scene.layers.size(), 1U);
    EXPECT_EQ(scene.layers[0].clearcoat, 0.5F);
    EXPECT_EQ(scene.lights[0].intensity[1], 3.0F);
    EXPECT_EQ(scene.cameras[0].yfov_rad, 1.5);
    EXPECT_EQ(load_tree(builder.finished()).scene->materials[1].base_color[0], 1.0F);
}

TEST(Pose, PointersReachTextureTransforms) {
    AssetBuilder builder = pointed_asset();
    const std::string transform =
        "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/";
    add_animation(
        builder,
        "Scroll",
        {{pointer_target((transform + "offset").c_str()), {0, 1}, "VEC2", {0, 0, 1, 0.5F}},
         {pointer_target((transform + "scale").c_str()), {0, 1}, "VEC2", {1, 1, 3, 5}},
         {pointer_target((transform + "rotation").c_str()), {0, 2}, "SCALAR", {0, 2}}});
    const Loaded loaded = load_at(builder.finished(), 0.5);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    const float* m = loaded.scene->materials[1].base_color_texture.uv_from_mesh;
    const float c = std::cos(0.5F);
    const float s = std::sin(0.5F);
    const F expected = {2 * c, 3 * s, 0.5F, -2 * s, 3 * c, 0.25F};
    EXPECT_THAT(F(m, m + 6), Pointwise(FloatNear(1e-6F), expected));
}

TEST(Pose, AnimatedValuesMustBeGoodOnes) {
    AssetBuilder builder = pointed_asset();
    add_animation(builder,
                  "Squint",
                  {{pointer_target("/cameras/0/perspective/yfov"), {0, 1}, "SCALAR", {1, -1}}});
    EXPECT_TRUE(load_at(builder.finished(), 0.25).scene);
    const Loaded loaded = load_at(builder.finished(), 1);
    EXPECT_EQ(loaded.id(), "E-CAM-FOV");
    EXPECT_THAT(loaded.text(), testing::HasSubstr("#/cameras/0/perspective/yfov"));
}

TEST(Pose, WhatCannotBeAnimatedIsNamed) {
    AssetBuilder builder = triangle_builder();
    builder.tree["nodes"][0]["name"] = "Fixed";
    builder.tree["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    add_animation(builder,
                  "Odd",
                  {{node_target(0, "translation"), {0}, "VEC3", {1, 2, 3}},
                   {pointer_target("/nodes/7/scale"), {0}, "VEC3", {1, 2, 3}},
                   {node_target(0, "weights"), {0}, "SCALAR", {1}},
                   {node_target(0, "shear"), {0}, "SCALAR", {1}}});
    const Loaded loaded = load_at(builder.finished(), 1);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(left_of(loaded), 0.0F);
    EXPECT_TRUE(loaded.warns("nodes with a matrix cannot be animated")) << loaded.warnings;
    EXPECT_TRUE(loaded.warns("/nodes/7/scale")) << loaded.warnings;
    EXPECT_TRUE(loaded.warns("shear")) << loaded.warnings;
    EXPECT_EQ(loaded.scene->info.animations[0].channels, 0U);
}

TEST(Pose, TheEndOfAnAnimationIsTold) {
    const Loaded loaded = load_tree(moving_triangle().finished());
    ASSERT_EQ(loaded.scene->info.animations.size(), 1U);
    EXPECT_EQ(loaded.scene->info.animations[0].name, "Slide");
    EXPECT_EQ(loaded.scene->info.animations[0].channels, 1U);
    EXPECT_EQ(loaded.scene->info.animations[0].end_s, 2);
}

/// A channel's fault: what the samplers or channels look like, and the error.
struct BadAnimation {
    Movement movement;
    const char* id;
};

TEST(Pose, BrokenAnimationsAreRefused) {
    const BadAnimation entries[] = {
        {{node_target(0, "translation"), {1, 0}, "VEC3", {0, 0, 0, 1, 1, 1}}, "E-ANIM-TIMES"},
        {{node_target(0, "translation"), {0, NAN}, "VEC3", {0, 0, 0, 1, 1, 1}}, "E-ANIM-TIMES"},
        {{node_target(0, "rotation"), {0}, "VEC4", {0, INFINITY, 0, 1}}, "E-ANIM-VALUE"},
        {{node_target(0, "rotation"), {0}, "VEC4", {0, 0, 0, 0}}, "E-ANIM-VALUE"},
        {{node_target(0, "translation"), {0, 1}, "VEC3", {0, 0, 0}}, "E-ANIM-COUNT"},
        {{node_target(0, "scale"), {0}, "VEC3", {0, 0, 0}, "CUBICSPLINE"}, "E-ANIM-COUNT"},
        {{node_target(0, "rotation"), {0}, "VEC3", {0, 0, 0}}, "E-ANIM-OUTPUT"},
        {{node_target(0, "scale"), {0}, "VEC3", {1, 1, 1}, "BOUNCE"}, "E-ANIM-MODE"},
        {{node_target(9, "scale"), {0}, "VEC3", {1, 1, 1}}, "E-DOC-INDEX"},
    };
    for (const BadAnimation& entry : entries) {
        AssetBuilder builder = triangle_builder();
        add_animation(builder, "Bad", {entry.movement});
        const Loaded loaded = load_at(builder.finished(), 0);
        EXPECT_EQ(loaded.id(), entry.id) << loaded.text();
        EXPECT_EQ(loaded.code(), 65);
    }
    AssetBuilder builder = moving_triangle();
    builder.tree["animations"][0]["samplers"][0]["input"] = 0;
    EXPECT_EQ(load_at(builder.finished(), 0).id(), "E-ANIM-INPUT");
}

/// Images are decoded once: each scene reuses those of the last; equal times, equal scenes.
TEST(PosedAsset, GivesScenesInAnyOrder) {
    AssetBuilder builder = pointed_asset();
    add_animation(
        builder, "Slide", {{node_target(0, "translation"), {0, 2}, "VEC3", {0, 0, 0, 4, 0, 0}}});
    const TempFolder folder;
    const auto file = folder.write("scene.gltf", builder.finished().dump());
    Log log(Verbosity::quiet);
    Result<PosedAsset> asset = PosedAsset::open(file, {}, true, log);
    ASSERT_TRUE(asset);
    for (const double time_s : {2.0, 0.5, 1.0, 0.5}) {
        Result<Scene> scene = asset->scene_at(time_s, false, log);
        ASSERT_TRUE(scene);
        const Loaded alone = load_at(builder.finished(), time_s);
        EXPECT_EQ(scene->positions, alone.scene->positions);
        EXPECT_EQ(scene->textures.texels, alone.scene->textures.texels);
        EXPECT_EQ(scene->info.images.size(), 1U);
        const uint32_t* texels = scene->textures.texels.data();
        asset->take_back(std::move(*scene));
        Result<Scene> next = asset->scene_at(time_s, false, log);
        ASSERT_TRUE(next);
        EXPECT_EQ(next->textures.texels.data(), texels) << "moved, not decoded";
        asset->take_back(std::move(*next));
    }
}

/// The asset while a shutter is open from 0.5 to 1 s.
Result<Scene> scene_while_open(AssetBuilder& builder) {
    const TempFolder folder;
    const auto file = folder.write("scene.gltf", builder.finished().dump());
    Log log(Verbosity::quiet);
    Result<PosedAsset> asset = PosedAsset::open(file, {}, true, log);
    if (!asset) return fail(asset.error());
    return asset->scene_between({0.5, 1.0}, true, log);
}

/// While the shutter is open the triangle slides by a quarter of its path: nine poses are kept.
TEST(PosedAsset, KeepsWhatMovesWhileAShutterIsOpen) {
    AssetBuilder builder = pointed_asset();
    add_animation(
        builder, "Slide", {{node_target(0, "translation"), {0, 2}, "VEC3", {0, 0, 0, 4, 0, 0}}});
    const Result<Scene> scene = scene_while_open(builder);
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->positions, load_at(builder.finished(), 0.5).scene->positions);
    EXPECT_EQ(scene->motion.steps, 9);
    EXPECT_FALSE(moves(scene->primitives[0])) << "the triangle stays in its node's space";
    ASSERT_EQ(scene->instances.size(), 1U);
    ASSERT_TRUE(moves(scene->instances[0]));
    for (size_t step = 0; step < 9; ++step) {
        const Affinef& map =
            scene->motion.instances[static_cast<size_t>(scene->instances[0].motion) + step];
        EXPECT_FLOAT_EQ(map.m[0][3], 1.0F + static_cast<float>(step) / 8.0F) << step;
    }
    EXPECT_FALSE(scene->materials.empty());
}

/// So are the nine poses of a deformed mesh, vertex by vertex, and of a lamp.
TEST(PosedAsset, KeepsWhatBendsWhileAShutterIsOpen) {
    AssetBuilder builder = pointed_asset();
    const int target = builder.add_accessor("VEC3", 5126, F{0, 0, 0, 1, 0, 0, 0, 0, 0});
    builder.tree["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", target}}};
    add_animation(builder,
                  "Bend",
                  {{node_target(0, "weights"), {0, 2}, "SCALAR", {0, 1}},
                   {node_target(1, "translation"), {0, 2}, "VEC3", {0, 0, 0, 4, 0, 0}}});
    const Result<Scene> scene = scene_while_open(builder);
    ASSERT_TRUE(scene);
    const Loaded closing = load_at(builder.finished(), 1.0);
    const Primitive& primitive = scene->primitives[0];
    ASSERT_TRUE(moves(primitive));
    const auto last = static_cast<size_t>(primitive.motion_base + 8 * primitive.motion_stride);
    for (size_t i = 0; i < 9; ++i)
        EXPECT_EQ(scene->motion.positions[last + i], closing.scene->positions[i]) << i;
    ASSERT_EQ(scene->motion.lights.size(), 9U);
    EXPECT_EQ(scene->motion.lights[0].position[0], 1.0F);
    EXPECT_EQ(scene->motion.lights[8].position[0], 2.0F);
}

/// Lamps by photometric files, which belong to nodes.
TEST(Pose, PointersReachLightProfiles) {
    AssetBuilder builder = triangle_builder();
    const char* const lamp = "TILT=NONE\n1 1000 1 2 1 1 2 0 0 0 1 1 50 0 90 0 100 100";
    builder.tree["extensions"]["EXT_lights_ies"]["lights"][0]["bufferView"] =
        builder.add_view(std::string("IESNA:LM-63-2002\n") + lamp);
    builder.tree["extensions"]["EXT_lights_ies"]["lights"][0]["mimeType"] =
        "application/x-ies-lm-63";
    builder.add_root({{"extensions", {{"EXT_lights_ies", {{"light", 0}}}}}});
    add_animation(
        builder,
        "Dim",
        {{pointer_target("/nodes/1/extensions/EXT_lights_ies/multiplier"),
          {0, 1},
          "SCALAR",
          {0, 4}},
         {pointer_target("/nodes/1/extensions/EXT_lights_ies/color"),
          {0, 1},
          "VEC3",
          {1, 1, 1, 0, 0.5F, 2}},
         {pointer_target("/nodes/0/extensions/EXT_lights_ies/color"), {0}, "VEC3", {1, 1, 1}}});
    const Loaded loaded = load_at(builder.finished(), 0.5);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    ASSERT_EQ(loaded.scene->lights.size(), 1U);
    const float* got = loaded.scene->lights[0].intensity;
    EXPECT_EQ(F(got, got + 3), (F{1, 1.5F, 2})) << "twice (0.5, 0.75, 1)";
    EXPECT_EQ(loaded.scene->static_primitive_count, 1) << "the lamp's node does not move";
}

}  // namespace
}  // namespace obscura::gltf
