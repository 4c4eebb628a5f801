// tests/gltf/meshes_test.cpp - meshes in the world: baked, mirrored, instanced.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/meshes.h"

#include "gltf/geometry/mesh_append.h"
#include "gltf/gltf_files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <gmock/gmock.h>

namespace obscura::gltf {
namespace {

using namespace test;
using testing::FloatNear;
using testing::Pointwise;
using F = std::vector<float>;

std::vector<float> low_of(const Scene& scene) {
    return {scene.bounds.low.x, scene.bounds.low.y, scene.bounds.low.z};
}

std::vector<float> high_of(const Scene& scene) {
    return {scene.bounds.high.x, scene.bounds.high.y, scene.bounds.high.z};
}

/// The triangle's normal by its winding, times twice its area.
std::vector<float> winding_normal(const Scene& scene, size_t triangle) {
    const F a = position_of(scene, scene.indices[3 * triangle]);
    const F b = position_of(scene, scene.indices[3 * triangle + 1]);
    const F c = position_of(scene, scene.indices[3 * triangle + 2]);
    const Vec3f n = cross(Vec3f{b[0] - a[0], b[1] - a[1], b[2] - a[2]},
                          Vec3f{c[0] - a[0], c[1] - a[1], c[2] - a[2]});
    return {n.x, n.y, n.z};
}

Loaded load_placed(const std::vector<json>& nodes) {
    AssetBuilder builder = triangle_builder();
    builder.tree.erase("nodes");
    builder.tree.erase("scenes");
    for (json node : nodes) {
        node["mesh"] = 0;
        builder.add_root(node);
    }
    return load_tree(builder.finished());
}

TEST(Meshes, TextureCoordinatesWithoutATextureAreKeptOnRequest) {
    const json tree = triangle_builder().finished();
    const Loaded plain = load_tree(tree);
    ASSERT_TRUE(plain.scene) << plain.text();
    EXPECT_EQ(plain.scene->primitives[0].uv_base[0], no_attribute);
    LoadOptions options;
    options.keeps_uv = true;
    const Loaded kept = load_tree(tree, options);
    ASSERT_TRUE(kept.scene) << kept.text();
    EXPECT_NE(kept.scene->primitives[0].uv_base[0], no_attribute);
    EXPECT_EQ(kept.scene->attributes.size(), plain.scene->attributes.size() + 2 * size_t{3});
}

TEST(Meshes, OneUseIsBakedToTheWorld) {
    const Loaded loaded = load_placed({{{"translation", {10, 0, 0}}, {"scale", {1, 3, 1}}}});
    ASSERT_TRUE(loaded.scene) << loaded.text();
    const Scene& scene = *loaded.scene;
    EXPECT_EQ(loaded.warnings, "");
    EXPECT_EQ(scene.world_primitive_count, 1);
    EXPECT_TRUE(scene.meshes.empty());
    EXPECT_TRUE(scene.instances.empty());
    ASSERT_EQ(scene.primitives.size(), 1U);
    EXPECT_EQ(scene.primitives[0].node, 0);
    EXPECT_EQ(scene.primitives[0].triangle_count, 1);
    EXPECT_EQ(scene.primitives[0].material, 0);
    EXPECT_EQ(scene.primitives[0].tangent_base, no_attribute);
    EXPECT_EQ(scene.positions,
              (LargeArray<float>{10, 0, 0, 12, 0, 0, 10, 3, 0, 0, 0, 0, 0}));  // padded by 4
    EXPECT_EQ(low_of(scene), (F{10, 0, 0}));
    EXPECT_EQ(high_of(scene), (F{12, 3, 0}));
    EXPECT_EQ(scene.info.triangles_in_world, 1U);
}

TEST(Meshes, NormalsGoByTheInverseTranspose) {
    AssetBuilder builder = triangle_builder();
    const float half = std::sqrt(0.5f);
    builder.add_accessor("VEC3", 5126, F{half, half, 0, 0, 0, 1, 0, 0, 1});
    builder.tree["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = 4;
    builder.tree["nodes"][0]["scale"] = {1, 2, 1};
    const Loaded loaded = load_tree(builder.finished());
    ASSERT_TRUE(loaded.scene) << loaded.text();
    // (1, 1/2) made unit
    EXPECT_THAT(attribute_of(*loaded.scene, loaded.scene->primitives[0].normal_base, 0, 3),
                Pointwise(FloatNear(1e-6f), F{2 / std::sqrt(5.0f), 1 / std::sqrt(5.0f), 0}));
}

TEST(Meshes, AMirrorTurnsTriangleAndHandednessRound) {  // E7
    for (const json& scale : {json{-1, 1, 1}, json{1, -2, 1}, json{-1, -1, -1}}) {
        const Loaded loaded = load_placed({{{"scale", scale}}});
        ASSERT_TRUE(loaded.scene) << loaded.text();
        const Scene& scene = *loaded.scene;
        const F normal = attribute_of(scene, scene.primitives[0].normal_base, 0, 3);
        EXPECT_GT(winding_normal(scene, 0)[2] * normal[2], 0) << scale;
        EXPECT_EQ(normal[2], scale[2].get<float>()) << scale;
    }
    MeshPrimitive primitive;
    primitive.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    primitive.normals = {0, 0, 1, 0, 0, 1, 0, 0, 1};
    primitive.tangents = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1};
    primitive.indices = {0, 1, 2};
    Affined mirror;
    mirror.m[0][0] = -3;
    ASSERT_TRUE(bake_primitive(primitive, mirror));
    EXPECT_EQ(primitive.indices, (std::vector<uint32_t>{0, 2, 1}));
    EXPECT_EQ(primitive.normals, (F{0, 0, 1, 0, 0, 1, 0, 0, 1}));
    EXPECT_EQ(primitive.tangents, (F{-1, 0, 0, -1, -1, 0, 0, -1, -1, 0, 0, 1}));
}

TEST(Meshes, SeveralUsesBecomeInstances) {
    const Loaded loaded = load_placed(
        {{{"translation", {10, 0, 0}}}, {{"scale", {-1, 1, 2}}}, {{"translation", {0, 0, -4}}}});
    ASSERT_TRUE(loaded.scene) << loaded.text();
    const Scene& scene = *loaded.scene;
    EXPECT_EQ(scene.world_primitive_count, 0);
    ASSERT_EQ(scene.meshes.size(), 1U);
    EXPECT_EQ(scene.meshes[0].first_primitive, 0);
    EXPECT_EQ(scene.meshes[0].primitive_count, 1);
    EXPECT_EQ(scene.primitives[0].node, -1);
    EXPECT_EQ(position_of(scene, 1), (F{2, 0, 0}));  // object space
    ASSERT_EQ(scene.instances.size(), 3U);
    EXPECT_EQ(scene.instances[0].world_from_object.m[0][3], 10);
    EXPECT_EQ(scene.instances[0].object_from_world.m[0][3], -10);
    EXPECT_EQ(scene.instances[1].object_from_world.m[2][2], 0.5f);
    EXPECT_EQ(scene.instances[0].mirrored, 0);
    EXPECT_EQ(scene.instances[1].mirrored, 1);
    EXPECT_EQ(scene.instances[2].node, 2);
    EXPECT_EQ(low_of(scene), (F{-2, 0, -4}));
    EXPECT_EQ(high_of(scene), (F{12, 1, 0}));
    EXPECT_EQ(scene.info.triangles_in_world, 3U);
}

TEST(Meshes, WorldPrimitivesComeFirst) {
    AssetBuilder builder = triangle_builder();
    const json primitive = builder.tree["meshes"][0]["primitives"][0];
    builder.add_mesh(primitive);
    builder.tree["meshes"][1]["primitives"].push_back(primitive);
    builder.tree["nodes"][0]["translation"] = {5, 0, 0};
    builder.add_root({{"mesh", 0}});
    builder.add_root({{"mesh", 1}, {"translation", {0, 0, 9}}});
    const Loaded loaded = load_tree(builder.finished());
    ASSERT_TRUE(loaded.scene) << loaded.text();
    const Scene& scene = *loaded.scene;
    EXPECT_EQ(scene.world_primitive_count, 2);
    ASSERT_EQ(scene.primitives.size(), 3U);
    EXPECT_EQ(scene.primitives[1].node, 2);
    EXPECT_EQ(scene.primitives[1].first_triangle, 1);
    EXPECT_EQ(scene.meshes[0].first_primitive, 2);
    EXPECT_EQ(scene.indices, (LargeArray<uint32_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 0}));
    // The base of an attribute is such that the absolute vertex number finds its place.
    EXPECT_EQ(attribute_of(scene, scene.primitives[1].normal_base, 4, 3), (F{0, 0, 1}));
    EXPECT_EQ(position_of(scene, 4), (F{2, 0, 9}));
}

TEST(Meshes, NodesThatLeaveNoAreaAreSkippedAndNamed) {  // E6
    const Loaded loaded = load_placed({{{"name", "Line"}, {"scale", {1, 0, 0}}}, json::object()});
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.scene->world_primitive_count, 1);
    EXPECT_TRUE(loaded.scene->instances.empty());
    EXPECT_TRUE(loaded.warns("not drawn: Line")) << loaded.warnings;
}

/// A slanting triangle is flattened into the plane z = 5, beside two instances of it. An axis that
/// mirrors reverses it, as happens to anything seen from its other side.
TEST(Meshes, NodesThatFlattenAreDrawn) {
    for (const float x : {1.0f, -1.0f}) {
        AssetBuilder builder = triangle_builder();
        builder.add_accessor("VEC3", 5126, F{0, 0, -1, 2, 0, 3, 0, 1, 0});
        builder.add_accessor("VEC3", 5126, F{0, 0, 1, 0.6f, 0, 0.8f, 0, 0.6f, 0.8f});
        json& attributes = builder.tree["meshes"][0]["primitives"][0]["attributes"];
        attributes["POSITION"] = 4;
        attributes["NORMAL"] = 5;
        builder.add_root(
            {{"mesh", 0}, {"name", "Flat"}, {"scale", {x, 3, 0}}, {"translation", {0, 0, 5}}});
        builder.add_root({{"mesh", 0}});
        const Loaded loaded = load_tree(builder.finished());
        ASSERT_TRUE(loaded.scene) << loaded.text();
        const Scene& scene = *loaded.scene;
        EXPECT_TRUE(loaded.warns("drawn flat: Flat")) << loaded.warnings;
        EXPECT_EQ(scene.instances.size(), 2U);
        ASSERT_EQ(scene.world_primitive_count, 1);
        EXPECT_EQ(position_of(scene, 0), (F{0, 0, 5}));
        EXPECT_EQ(position_of(scene, 1), (F{2 * x, 0, 5}));
        EXPECT_EQ(position_of(scene, 2), (F{0, 3, 5}));
        EXPECT_GT(x * winding_normal(scene, 0)[2], 0);
        for (uint32_t vertex = 0; vertex < 3; ++vertex) {
            EXPECT_EQ(attribute_of(scene, scene.primitives[0].normal_base, vertex, 3),
                      (F{0, 0, x}));
        }
    }
}

TEST(Meshes, TinyScalesAreFine) {
    const Loaded loaded = load_placed({{{"scale", {1e-12, 1e-12, 1e-12}}}});
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_FLOAT_EQ(position_of(*loaded.scene, 1)[0], 2e-12f);
    EXPECT_EQ(attribute_of(*loaded.scene, loaded.scene->primitives[0].normal_base, 0, 3),
              (F{0, 0, 1}));
}

TEST(Meshes, InstancesBeyondSinglePrecisionAreErrors) {
    const json tiny = {{"scale", {1e-42, 1e-42, 1e-42}}};
    EXPECT_EQ(load_placed({tiny, json::object()}).id(), "E-NODE-RANGE");
    const json far = {{"translation", {1e20, 0, 0}}};
    EXPECT_EQ(load_placed({json::object(), far}).id(), "E-NODE-RANGE");
}

TEST(Meshes, UnusedMeshesTakeNoRoom) {
    AssetBuilder builder = triangle_builder();
    builder.add_mesh(builder.tree["meshes"][0]["primitives"][0]);
    builder.tree["meshes"][1]["name"] = "Spare";
    const Loaded loaded = load_tree(builder.finished());
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.scene->indices.size(), 3U + 1);
    ASSERT_EQ(loaded.scene->info.meshes.size(), 2U);
    EXPECT_EQ(loaded.scene->info.meshes[0].name, "mesh 0");
    EXPECT_EQ(loaded.scene->info.meshes[1].name, "Spare");
    EXPECT_EQ(loaded.scene->info.meshes[1].count, 1U);
}

TEST(Meshes, LimitsAreThoseOf32Bits) {
    constexpr size_t words = (1ULL << 31) - 1;
    constexpr size_t vertices = (1ULL << 29) - 1;
    EXPECT_EQ(broken_limit({vertices, words, words}), nullptr);
    EXPECT_STREQ(broken_limit({vertices + 1, 0, 0}), "E-LIMIT-VERTICES");
    EXPECT_STREQ(broken_limit({0, words + 1, 0}), "E-LIMIT-TRIANGLES");
    EXPECT_STREQ(broken_limit({0, 0, words + 1}), "E-LIMIT-ATTRIBUTES");
}

}  // namespace
}  // namespace obscura::gltf
