// tests/gltf/deform_test.cpp - morph targets and skins against vertices worked out by hand.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/deform.h"

#include "gltf/animated_files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <gmock/gmock.h>

namespace obscura::gltf {
namespace {

using namespace test;
using testing::FloatNear;
using testing::Pointwise;
using F = std::vector<float>;

F positions_of(const Loaded& loaded) {
    if (!loaded.scene || loaded.scene->positions.size() < 9) return {};
    return {loaded.scene->positions.begin(), loaded.scene->positions.begin() + 9};
}

/// A triangle on two joints: vertex 0 moves with the first, 1 with the second, 2 with half of each.
/// The second joint is bound at (1, 0, 0) and rotated by 90 degrees about z.
AssetBuilder skinned_triangle(const std::vector<float>& weights = {1,
                                                                   0,
                                                                   0,
                                                                   0,
                                                                   0,
                                                                   1,
                                                                   0,
                                                                   0,  //
                                                                   0.5F,
                                                                   0.5F,
                                                                   0,
                                                                   0}) {
    AssetBuilder builder = triangle_builder();
    const int joints = builder.add_accessor(
        "VEC4", 5121, std::vector<uint8_t>{0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0});
    const int weight = builder.add_accessor("VEC4", 5126, weights);
    const int inverse =
        builder.add_accessor("MAT4", 5126, F{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,
                                             1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1});
    json& attributes = builder.tree["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = joints;
    attributes["WEIGHTS_0"] = weight;
    builder.tree["nodes"][0]["skin"] = 0;
    builder.tree["nodes"][0]["translation"] = {100, 0, 0};  // does not count
    builder.tree["nodes"].push_back({{"children", {2}}, {"translation", {0, 0, 3}}});
    const double half = std::sqrt(0.5);
    builder.tree["nodes"].push_back({{"translation", {1, 0, 0}}, {"rotation", {0, 0, half, half}}});
    builder.tree["skins"][0] = {
        {"joints", {1, 2}}, {"inverseBindMatrices", inverse}, {"skeleton", 1}};
    return builder;
}

TEST(Skin, VerticesFollowTheirJoints) {
    const Loaded loaded = load_tree(skinned_triangle().finished());
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.warnings, "");
    // (2, 0, 0) is (1, 0, 0) from the second joint: turned to (0, 1, 0), it lies at (1, 1, 3).
    // (0, 1, 0) stays, or from (-1, 1, 0) turns to (-1, -1, 0): the mean of (0, 1, 3), (0, -1, 3).
    EXPECT_THAT(positions_of(loaded), Pointwise(FloatNear(1e-6F), F{0, 0, 3, 1, 1, 3, 0, 0, 3}));
    EXPECT_EQ(loaded.scene->primitives[0].node, 0);
    const Primitive& primitive = loaded.scene->primitives[0];
    EXPECT_THAT(attribute_of(*loaded.scene, primitive.normal_base, 1, 3),
                Pointwise(FloatNear(1e-6F), F{0, 0, 1}));
}

TEST(Skin, JointsAreAnimated) {
    AssetBuilder builder = skinned_triangle();
    add_animation(
        builder, "Bend", {{node_target(2, "rotation"), {0, 1}, "VEC4", {0, 0, 0, 1, 0, 0, 1, 0}}});
    const Loaded rest = load_at(builder.finished(), 0);
    EXPECT_THAT(positions_of(rest), Pointwise(FloatNear(1e-6F), F{0, 0, 3, 2, 0, 3, 0, 1, 3}));
    const Loaded bent = load_at(builder.finished(), 1);  // 180 degrees
    EXPECT_THAT(positions_of(bent), Pointwise(FloatNear(1e-6F), F{0, 0, 3, 0, 0, 3, 1, 0, 3}));
}

TEST(Skin, SeveralSetsAddUp) {
    AssetBuilder builder = skinned_triangle({0.5F, 0, 0, 0, 0, 1, 0, 0, 0.5F, 0.5F, 0, 0});
    json& attributes = builder.tree["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_1"] = builder.add_accessor(
        "VEC4", 5123, std::vector<uint16_t>{1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    attributes["WEIGHTS_1"] =
        builder.add_accessor("VEC4", 5126, F{0.5F, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    const Loaded loaded = load_tree(builder.finished());
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.warnings, "");
    // (0, 0, 0) is (-1, 0, 0) from the second joint, turned (0, -1, 0): at (1, -1, 3).
    const F all = positions_of(loaded);
    EXPECT_THAT(F(all.begin(), all.begin() + 3), Pointwise(FloatNear(1e-6F), F{0.5F, -0.5F, 3}));
}

TEST(Skin, WeightsAreMadeToSumToOne) {
    const Loaded loaded =
        load_tree(skinned_triangle({0, 0, 0, 0, 0, 3, 0, 0, 0.5F, 0.5F, -1, 0}).finished());
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_TRUE(loaded.warns("skin weights")) << loaded.warnings;
    EXPECT_THAT(positions_of(loaded), Pointwise(FloatNear(1e-6F), F{0, 0, 3, 1, 1, 3, 0, 0, 3}));
}

TEST(Skin, WithoutJointsTheNodePlacesIt) {
    AssetBuilder builder = skinned_triangle();
    builder.tree["meshes"][0]["primitives"][0]["attributes"].erase("JOINTS_0");
    const Loaded loaded = load_tree(builder.finished());
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_TRUE(loaded.warns("without JOINTS_0")) << loaded.warnings;
    EXPECT_EQ(loaded.scene->bounds.low.x, 100.0F);
}

TEST(Skin, TwoNodesWithOneSkinnedMeshAreBakedEach) {
    AssetBuilder builder = skinned_triangle();
    builder.add_root({{"mesh", 0}, {"skin", 1}});
    builder.add_root({{"mesh", 0}});
    builder.tree["skins"][1] = {{"joints", {0, 0}}};
    const Loaded loaded = load_tree(builder.finished());
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_TRUE(loaded.scene->instances.empty());
    EXPECT_EQ(loaded.scene->world_primitive_count, 3);
    EXPECT_EQ(loaded.scene->bounds.high.x, 102.0F) << "joint 0 is the node at x = 100";
}

TEST(Skin, BrokenSkinsAreRefused) {
    const auto id_with = [](const char* pointer, const json& value) {
        json tree = skinned_triangle().finished();
        tree[json::json_pointer(pointer)] = value;
        return load_tree(tree).id();
    };
    EXPECT_EQ(id_with("/skins/0/joints", json::array()), "E-SKIN-JOINT");
    EXPECT_EQ(id_with("/skins/0/joints", {1}), "E-SKIN-JOINT") << "C16: vertices ask for two";
    EXPECT_EQ(id_with("/skins/0/joints", {1, 9}), "E-DOC-INDEX");
    EXPECT_EQ(id_with("/skins/0/joints", {1, 2, 1}), "E-SKIN-MATRICES");
    EXPECT_EQ(id_with("/skins/0/skeleton", 9), "E-DOC-INDEX") << "E12";
    EXPECT_EQ(id_with("/skins/0/inverseBindMatrices", 0), "E-SKIN-MATRICES");
    EXPECT_EQ(id_with("/meshes/0/primitives/0/attributes/WEIGHTS_0", 0), "E-MESH-ATTRIBUTE");
    AssetBuilder builder = skinned_triangle();
    F matrices(32, 0.0F);
    matrices[5] = NAN;
    builder.tree["skins"][0]["inverseBindMatrices"] = builder.add_accessor("MAT4", 5126, matrices);
    EXPECT_EQ(load_tree(builder.finished()).id(), "E-SKIN-MATRICES") << "C22";
}

/// Each vertex by its own matrix: shear and scale for the normal, a mirror for the winding.
TEST(SkinPrimitive, NormalsGoByTheInverseTransposeAndMirrorsTurnTriangles) {
    MeshPrimitive primitive;
    primitive.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    primitive.normals = {0, 0.6F, 0.8F, 0, 0, 1, 0, 0, 1};
    primitive.tangents = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1};
    primitive.indices = {0, 1, 2};
    const Affined wide = {{{-2, 0, 0, 0}, {0, 4, 0, 0}, {0, 0, 1, 5}}};
    const VertexJoints joints{1, {0, 0, 0}, {1, 1, 1}};
    skin_primitive(joints, std::span(&wide, 1), primitive);
    EXPECT_TRUE(primitive.in_world);
    EXPECT_EQ(primitive.positions, (F{0, 0, 5, -2, 0, 5, 0, 4, 5}));
    const double length = std::hypot(0.15, 0.8);
    EXPECT_NEAR(primitive.normals[1], 0.15 / length, 1e-7);
    EXPECT_NEAR(primitive.normals[2], 0.8 / length, 1e-7);
    EXPECT_EQ(F(primitive.tangents.begin(), primitive.tangents.begin() + 4), (F{-1, 0, 0, -1}));
    EXPECT_EQ(primitive.indices, (std::vector<uint32_t>{0, 2, 1}));
}

/// A triangle with two targets: the first moves vertex 1 by a sparse accessor, the second all.
AssetBuilder morphed_triangle() {
    AssetBuilder builder = triangle_builder();
    const int where = builder.add_view(raw(std::vector<uint16_t>{1}));
    const int what = builder.add_view(raw(F{0, 0, 8}));
    builder.tree["accessors"].push_back(
        {{"componentType", 5126},
         {"count", 3},
         {"type", "VEC3"},
         {"sparse",
          {{"count", 1},
           {"indices", {{"bufferView", where}, {"componentType", 5123}}},
           {"values", {{"bufferView", what}}}}}});
    const int first = static_cast<int>(builder.tree["accessors"].size()) - 1;
    const int second = builder.add_accessor("VEC3", 5126, F{0, 4, 0, 0, 4, 0, 0, 4, 0});
    const int normals = builder.add_accessor("VEC3", 5126, F{1, 0, -1, 1, 0, -1, 1, 0, -1});
    builder.tree["meshes"][0]["primitives"][0]["targets"] = {
        {{"POSITION", first}}, {{"POSITION", second}, {"NORMAL", normals}}};
    return builder;
}

TEST(Morph, WeightsComeFromMeshNodeAndAnimation) {
    AssetBuilder builder = morphed_triangle();
    EXPECT_EQ(positions_of(load_tree(builder.finished())), (F{0, 0, 0, 2, 0, 0, 0, 1, 0}));
    builder.tree["meshes"][0]["weights"] = {0.5, 0};
    const Loaded by_mesh = load_tree(builder.finished());
    EXPECT_EQ(positions_of(by_mesh), (F{0, 0, 0, 2, 0, 4, 0, 1, 0}));
    EXPECT_FALSE(by_mesh.warns("morph"));
    builder.tree["nodes"][0]["weights"] = {0.25, 1};
    const Loaded by_node = load_tree(builder.finished());
    EXPECT_EQ(positions_of(by_node), (F{0, 4, 0, 2, 4, 2, 0, 5, 0}));
    const Primitive& primitive = by_node.scene->primitives[0];
    EXPECT_EQ(attribute_of(*by_node.scene, primitive.normal_base, 0, 3), (F{1, 0, 0}));
    add_animation(
        builder, "Grow", {{node_target(0, "weights"), {0, 1}, "SCALAR", {0, 0, 1, 0.5F}}});
    const Loaded animated = load_at(builder.finished(), 0.5);
    EXPECT_EQ(positions_of(animated), (F{0, 1, 0, 2, 1, 4, 0, 2, 0}));
}

TEST(Morph, PointersReachWeights) {
    AssetBuilder builder = morphed_triangle();
    builder.tree["meshes"][0]["weights"] = {0.5, 0};
    add_animation(builder,
                  "One",
                  {{pointer_target("/nodes/0/weights/1"), {0, 1}, "SCALAR", {0, 1}},
                   {pointer_target("/meshes/0/weights"), {0}, "SCALAR", {1, 1}}});
    EXPECT_EQ(positions_of(load_at(builder.finished(), 1)), (F{0, 4, 0, 2, 4, 4, 0, 5, 0}));
}

/// Equal weights share one shape; others are meshes of their own.
TEST(Morph, ShapesAreSharedByWeights) {
    AssetBuilder builder = morphed_triangle();
    builder.add_root({{"mesh", 0}, {"translation", {0, 0, 50}}});
    builder.add_root({{"mesh", 0}, {"weights", {1, 0}}});
    const Loaded loaded = load_tree(builder.finished());
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.scene->instances.size(), 2U);
    EXPECT_EQ(loaded.scene->meshes.size(), 1U);
    EXPECT_EQ(loaded.scene->world_primitive_count, 1);
    EXPECT_EQ(loaded.scene->info.triangles_in_world, 3U);
}

TEST(Morph, ColoursAndTextureCoordinatesMove) {
    AssetBuilder builder = triangle_builder();
    json& primitive = builder.tree["meshes"][0]["primitives"][0];
    primitive["attributes"]["COLOR_0"] =
        builder.add_accessor("VEC3", 5126, F{0, 0, 0, 1, 1, 1, 0.5F, 0.5F, 0.5F});
    primitive["targets"][0]["COLOR_0"] =
        builder.add_accessor("VEC4", 5126, F{0.25F, 0, -1, 0, 1, 0, 0, 0, 0, 0, 0, -0.5F});
    builder.tree["meshes"][0]["weights"] = {1};
    const Loaded loaded = load_tree(builder.finished());
    ASSERT_TRUE(loaded.scene) << loaded.text();
    const Scene& scene = *loaded.scene;
    const int32_t base = scene.primitives[0].color_base;
    EXPECT_EQ(attribute_of(scene, base, 0, 4), (F{0.25F, 0, 0, 1}));
    EXPECT_EQ(attribute_of(scene, base, 1, 4), (F{1, 1, 1, 1})) << "clamped";
    EXPECT_EQ(attribute_of(scene, base, 2, 4), (F{0.5F, 0.5F, 0.5F, 0.5F}));
}

TEST(Morph, BrokenTargetsAreRefused) {
    const auto id_with = [](const char* pointer, const json& value) {
        json tree = morphed_triangle().finished();
        tree["meshes"][0]["weights"] = {1, 1};
        tree[json::json_pointer(pointer)] = value;
        return load_tree(tree).id();
    };
    EXPECT_EQ(id_with("/meshes/0/weights", {1}), "E-MESH-TARGETS");
    EXPECT_EQ(id_with("/nodes/0/weights", {1, 2, 3}), "E-MESH-TARGETS");
    EXPECT_EQ(id_with("/meshes/0/primitives/0/targets/1/POSITION", 2), "E-MESH-ATTRIBUTE");
    EXPECT_EQ(id_with("/meshes/0/weights", {1e30, 1}), "E-MESH-POSITION");
    json tree = morphed_triangle().finished();
    tree["meshes"][0]["primitives"].push_back(triangle_asset()["meshes"][0]["primitives"][0]);
    EXPECT_EQ(load_tree(tree).id(), "E-MESH-TARGETS");
}

/// The shutter of a camera wants the same vertices at several times.
TEST(Morph, EveryPoseHasTheSameLayout) {
    AssetBuilder builder = morphed_triangle();
    builder.tree["materials"][0]["extensions"]["KHR_materials_anisotropy"] = {
        {"anisotropyStrength", 1}};
    json& primitive = builder.tree["meshes"][0]["primitives"][0];
    primitive["material"] = 0;
    add_animation(
        builder, "Grow", {{node_target(0, "weights"), {0, 1}, "SCALAR", {0, 0, 1, 0.5F}}});
    const Loaded first = load_at(builder.finished(), 0);
    const Loaded second = load_at(builder.finished(), 0.7);
    ASSERT_TRUE(first.scene && second.scene) << first.text() << second.text();
    EXPECT_NE(first.scene->primitives[0].tangent_base, no_attribute);
    EXPECT_EQ(first.scene->indices, second.scene->indices);
    EXPECT_EQ(first.scene->attributes.size(), second.scene->attributes.size());
    EXPECT_NE(first.scene->positions, second.scene->positions);
}

}  // namespace
}  // namespace obscura::gltf
