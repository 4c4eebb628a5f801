// tests/gltf/instancing_test.cpp - EXT_mesh_gpu_instancing places a mesh once for each element.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/instancing.h"

#include "gltf/gltf_files.h"

#include <gtest/gtest.h>

#include <cmath>

namespace obscura::gltf {
namespace {

using namespace test;

constexpr const char* name = "EXT_mesh_gpu_instancing";

/// Marks the newest accessor as normalized.
int normalized(AssetBuilder& builder, int accessor) {
    builder.tree["accessors"][static_cast<size_t>(accessor)]["normalized"] = true;
    return accessor;
}

json& attributes_of(json& tree, size_t node = 0) {
    return tree["nodes"][node]["extensions"][name]["attributes"];
}

/// Where a point of the mesh stands through an instance.
std::vector<float> moved(const Instance& instance, const Vec3f& p) {
    const Vec3f q = transform_point(instance.world_from_object, p);
    return {q.x, q.y, q.z};
}

void expect_near(const std::vector<float>& got, const std::vector<float>& expected, double by) {
    ASSERT_EQ(got.size(), expected.size());
    for (size_t i = 0; i < got.size(); ++i)
        EXPECT_NEAR(got[i], expected[i], by) << i;
}

/// Scale, then rotation, then translation, then the node's own transform.
TEST(Instancing, EachElementIsAnInstance) {
    const float half = std::sqrt(0.5f);
    const std::vector<float> turns = {0, 0, 0, 1, 0, 0, half, half};  // none, 90 degrees about Z
    std::vector<int8_t> bytes;
    std::vector<int16_t> shorts;
    for (const float value : turns) {
        bytes.push_back(static_cast<int8_t>(std::lround(value * 127)));
        shorts.push_back(static_cast<int16_t>(std::lround(value * 32767)));
    }
    for (int kind = 0; kind < 3; ++kind) {
        AssetBuilder builder = triangle_builder();
        const int t = builder.add_accessor("VEC3", 5126, std::vector<float>{0, 0, 5, 1, 2, 3});
        const int s = builder.add_accessor("VEC3", 5126, std::vector<float>{1, 1, 1, 2, 3, 4});
        const int r = kind == 0   ? builder.add_accessor("VEC4", 5126, turns)
                      : kind == 1 ? normalized(builder, builder.add_accessor("VEC4", 5120, bytes))
                                  : normalized(builder, builder.add_accessor("VEC4", 5122, shorts));
        json tree = builder.finished();
        tree["nodes"][0]["translation"] = {100, 0, 0};
        attributes_of(tree) = {{"TRANSLATION", t}, {"ROTATION", r}, {"SCALE", s}, {"_ID", t}};
        const Loaded loaded = load_tree(tree);
        ASSERT_TRUE(loaded.scene) << loaded.text();
        EXPECT_EQ(loaded.warnings, "");
        ASSERT_EQ(loaded.scene->instances.size(), 2U);
        const Instance& first = loaded.scene->instances[0];
        const Instance& second = loaded.scene->instances[1];
        const double accuracy = kind == 1 ? 0.05 : 1e-3;
        expect_near(moved(first, {2, 0, 0}), {102, 0, 5}, accuracy);
        expect_near(moved(second, {0, 0, 0}), {101, 2, 3}, accuracy);
        expect_near(moved(second, {2, 0, 0}), {101, 6, 3}, accuracy);
        expect_near(moved(second, {0, 1, 0}), {98, 2, 3}, accuracy);
        EXPECT_EQ(first.node, 0);
        EXPECT_EQ(loaded.scene->info.triangles_in_world, 2U);
    }
}

TEST(Instancing, OneElementLiesInTheWorldAndSharesWithPlainNodes) {
    AssetBuilder builder = triangle_builder();
    const int t = builder.add_accessor("VEC3", 5126, std::vector<float>{0, 0, 5});
    json tree = builder.finished();
    attributes_of(tree)["TRANSLATION"] = t;
    const Loaded alone = load_tree(tree);
    ASSERT_TRUE(alone.scene) << alone.text();
    EXPECT_EQ(alone.scene->instances.size(), 0U);
    EXPECT_EQ(position_of(*alone.scene, 0), (std::vector<float>{0, 0, 5}));
    tree["nodes"].push_back({{"mesh", 0}});
    tree["scenes"][0]["nodes"].push_back(1);
    EXPECT_EQ(load_tree(tree).scene->instances.size(), 2U);
}

/// Children of an instanced node, and its camera, stand once.
TEST(Instancing, OnlyTheMeshIsRepeated) {
    AssetBuilder builder = triangle_builder();
    const int t = builder.add_accessor("VEC3", 5126, std::vector<float>{0, 0, 5, 0, 0, 6, 0, 0, 7});
    builder.add_mesh(builder.tree["meshes"][0]["primitives"][0]);
    json tree = builder.finished();
    attributes_of(tree)["TRANSLATION"] = t;
    tree["cameras"][0] = {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}};
    tree["nodes"][0]["camera"] = 0;
    tree["nodes"][0]["children"] = {1};
    tree["nodes"].push_back({{"mesh", 1}});
    const Loaded loaded = load_tree(tree);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.scene->instances.size(), 3U);
    EXPECT_EQ(loaded.scene->world_primitive_count, 1);
    EXPECT_EQ(loaded.scene->cameras.size(), 1U);
}

TEST(Instancing, BadElementsAreErrors) {
    AssetBuilder builder = triangle_builder();
    const int two = builder.add_accessor("VEC3", 5126, std::vector<float>{0, 0, 5, 0, 0, 6});
    const int one = builder.add_accessor("VEC3", 5126, std::vector<float>{1, 1, 1});
    const int zero = builder.add_accessor("VEC4", 5126, std::vector<float>(8, 0.0f));
    const int plain = builder.add_accessor("VEC4", 5120, std::vector<int8_t>(8, 1));
    const json good = builder.finished();
    struct Case {
        json attributes;
        const char* id;
    };
    for (const Case& c : {Case{{{"TRANSLATION", two}, {"SCALE", one}}, "E-NODE-INSTANCING"},
                          Case{{{"TRANSLATION", two}, {"ROTATION", zero}}, "E-NODE-INSTANCING"},
                          Case{{{"TRANSLATION", two}, {"ROTATION", plain}}, "E-NODE-INSTANCING"},
                          Case{{{"TRANSLATION", 3}}, "E-NODE-INSTANCING"},
                          Case{{{"SCALE", 99}}, "E-DOC-INDEX"}}) {
        json tree = good;
        attributes_of(tree) = c.attributes;
        const Loaded loaded = load_tree(tree);
        EXPECT_EQ(loaded.id(), c.id) << c.attributes;
        EXPECT_NE(loaded.text().find("#/nodes/0"), std::string::npos) << loaded.text();
    }
}

TEST(Instancing, CountsWithoutDataAreLimited) {  // F14
    AssetBuilder builder = triangle_builder();
    builder.tree["accessors"].push_back(
        {{"componentType", 5126}, {"type", "VEC3"}, {"count", 1'000'000'000}});
    json tree = builder.finished();
    attributes_of(tree)["TRANSLATION"] = 4;
    const Loaded loaded = load_tree(tree);
    EXPECT_EQ(loaded.code(), 77);
    EXPECT_EQ(loaded.id(), "E-LIMIT-INSTANCES");
}

/// An instance whose scale is zero is nothing to see; the others are drawn.
TEST(Instancing, FlatInstancesAreLeftOut) {
    AssetBuilder builder = triangle_builder();
    const int s = builder.add_accessor("VEC3", 5126, std::vector<float>{1, 1, 1, 0, 0, 0, 2, 2, 2});
    json tree = builder.finished();
    attributes_of(tree)["SCALE"] = s;
    const Loaded loaded = load_tree(tree);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.scene->instances.size(), 2U);
    EXPECT_TRUE(loaded.warns("scale is zero"));
}

}  // namespace
}  // namespace obscura::gltf
