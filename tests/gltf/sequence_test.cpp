// tests/gltf/sequence_test.cpp - geometry shared by the poses of one asset is read only once.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/animated_files.h"
#include "gltf/load.h"

#include <gtest/gtest.h>

#include <cstring>
#include <gmock/gmock.h>

namespace obscura::gltf {
namespace {

using namespace test;
using F = std::vector<float>;

json mesh_primitive(const AssetBuilder& builder) {
    return builder.tree["meshes"][0]["primitives"][0];
}

int add_child(AssetBuilder& builder, int parent, const json& node) {
    const int number = static_cast<int>(builder.tree["nodes"].size());
    builder.tree["nodes"].push_back(node);
    builder.tree["nodes"][static_cast<size_t>(parent)]["children"].push_back(number);
    return number;
}

/// Node 0 stands still; node 1 slides 4 m along x in 2 s and carries node 2 and one of two uses of
/// mesh 3.
AssetBuilder sliding_asset() {
    AssetBuilder builder = triangle_builder();
    const json primitive = mesh_primitive(builder);
    for (int i = 0; i < 3; ++i)
        builder.add_mesh(primitive);
    builder.add_root({{"mesh", 1}});
    add_child(builder, 1, {{"mesh", 2}, {"translation", {0, 5, 0}}});
    add_child(builder, 1, {{"mesh", 3}});
    builder.add_root({{"mesh", 3}, {"translation", {0, 0, 7}}});
    add_animation(
        builder, "Slide", {{node_target(1, "translation"), {0, 2}, "VEC3", {0, 0, 0, 4, 0, 0}}});
    return builder;
}

template <typename Record>
std::string bytes_of(const std::vector<Record>& records) {
    return {reinterpret_cast<const char*>(records.data()), records.size() * sizeof(Record)};
}

void expect_equal(const Scene& a, const Scene& b) {
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.indices, b.indices);
    EXPECT_EQ(a.attributes, b.attributes);
    EXPECT_EQ(bytes_of(a.primitives), bytes_of(b.primitives));
    EXPECT_EQ(bytes_of(a.instances), bytes_of(b.instances));
    EXPECT_EQ(bytes_of(a.materials), bytes_of(b.materials));
    EXPECT_EQ(a.spheres.size(), b.spheres.size());
    EXPECT_EQ(a.world_primitive_count, b.world_primitive_count);
    EXPECT_EQ(a.static_primitive_count, b.static_primitive_count);
    EXPECT_EQ(bytes_of(a.motion.instances), bytes_of(b.motion.instances));
    EXPECT_EQ(a.motion.positions, b.motion.positions);
    EXPECT_EQ(a.bounds.low.x, b.bounds.low.x);
    EXPECT_EQ(a.bounds.high.x, b.bounds.high.x);
    EXPECT_EQ(a.info.triangles_in_world, b.info.triangles_in_world);
}

/// An asset in a folder of its own.
struct OpenAsset {
    TempFolder folder;
    Log log{Verbosity::quiet};
    std::optional<PosedAsset> asset;

    explicit OpenAsset(const json& tree, const LoadOptions& options = {}) {
        const auto file = folder.write("scene.gltf", tree.dump());
        Result<PosedAsset> opened = PosedAsset::open(file, options, true, log);
        EXPECT_TRUE(opened) << opened.error().message;
        if (opened) asset = std::move(*opened);
    }
    Scene at(double time_s) {
        Result<Scene> scene = asset->scene_at(time_s, false, log);
        EXPECT_TRUE(scene) << scene.error().message;
        return scene ? std::move(*scene) : Scene();
    }
};

/// Every pose of a sequence equals that pose alone.
void expect_sequence(const json& tree) {
    OpenAsset open(tree);
    for (const double time_s : {2.0, 0.5, 0.0, 1.0, 1.0}) {
        SCOPED_TRACE(time_s);
        Scene scene = open.at(time_s);
        const Loaded alone = load_at(tree, time_s);
        ASSERT_TRUE(alone.scene) << alone.text();
        expect_equal(scene, *alone.scene);
        open.asset->take_back(std::move(scene));
        const ShutterTimes shutter{time_s, time_s + 0.25};
        Result<Scene> blurred = open.asset->scene_between(shutter, false, open.log);
        ASSERT_TRUE(blurred);
        OpenAsset fresh(tree);
        const Result<Scene> other = fresh.asset->scene_between(shutter, true, fresh.log);
        ASSERT_TRUE(other);
        expect_equal(*blurred, *other);
        open.asset->take_back(std::move(*blurred));
    }
}

TEST(Sequence, WhatAnAnimatedNodeMovesIsOneMeshInItsSpace) {
    const Loaded loaded = load_at(sliding_asset().finished(), 0.5);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    const Scene& scene = *loaded.scene;
    EXPECT_EQ(scene.static_primitive_count, 1);
    EXPECT_EQ(scene.world_primitive_count, 1);
    ASSERT_EQ(scene.meshes.size(), 2U);
    EXPECT_EQ(scene.meshes[0].first_primitive, 1);
    EXPECT_EQ(scene.meshes[0].primitive_count, 2);
    EXPECT_EQ(scene.primitives[1].node, 1);
    EXPECT_EQ(scene.primitives[2].node, 2);
    ASSERT_EQ(scene.instances.size(), 3U);
    EXPECT_EQ(scene.instances[0].node, -1);
    EXPECT_EQ(scene.instances[0].world_from_object.m[0][3], 1.0F);
    EXPECT_EQ(scene.instances[1].world_from_object.m[0][3], 1.0F) << "of mesh 3";
    EXPECT_EQ(scene.instances[2].world_from_object.m[2][3], 7.0F);
    EXPECT_EQ(position_of(scene, scene.indices[6]), (F{0, 5, 0}))
        << "in the space of the dynamic group";
    EXPECT_EQ(scene.info.triangles_in_world, 5U);
    EXPECT_EQ(scene.bounds.high.x, 3.0F);
    EXPECT_EQ(scene.bounds.high.y, 6.0F) << "vertex by vertex, as if it lay in the world";
}

TEST(Sequence, WithoutAnimationAllIsAsBefore) {
    const Loaded loaded = load_at(sliding_asset().finished(), 0.5, "none");
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.scene->world_primitive_count, 3);
    EXPECT_EQ(loaded.scene->static_primitive_count, 0);
    EXPECT_EQ(loaded.scene->meshes.size(), 1U);
    EXPECT_EQ(loaded.scene->meshes[0].stamp, 0U);
}

TEST(Sequence, GeometryThatNoTimeChangesIsReadOnce) {
    OpenAsset open(sliding_asset().finished());
    Scene first = open.at(0.5);
    const float* positions = first.positions.data();
    const GeometryStamp still = first.static_stamp;
    const GeometryStamp mesh = first.meshes[0].stamp;
    EXPECT_NE(still, 0U);
    EXPECT_NE(mesh, 0U);
    open.asset->take_back(std::move(first));
    Scene second = open.at(1.0);
    EXPECT_EQ(second.positions.data(), positions);
    EXPECT_EQ(second.static_stamp, still);
    EXPECT_EQ(second.meshes[0].stamp, mesh);
    const Scene third = open.at(1.5);
    EXPECT_NE(third.static_stamp, still) << "the scene was not given back";
    expect_equal(third, *load_at(sliding_asset().finished(), 1.5).scene);
}

TEST(Sequence, EveryPoseEqualsThatPoseAlone) {
    expect_sequence(sliding_asset().finished());
    AssetBuilder points = sliding_asset();
    points.tree["meshes"][2]["primitives"][0]["mode"] = 0;
    points.tree["meshes"][0]["primitives"][0]["mode"] = 1;
    expect_sequence(points.finished());
}

/// Morph targets deform a triangle: it alone is read for each pose.
TEST(Sequence, WhatBendsIsReadAgain) {
    AssetBuilder builder = sliding_asset();
    const int target = builder.add_accessor("VEC3", 5126, F{0, 0, 0, 1, 0, 0, 0, 0, 0});
    json primitive = mesh_primitive(builder);
    primitive["targets"] = {{{"POSITION", target}}};
    builder.add_root({{"mesh", builder.add_mesh(primitive)}});
    add_animation(builder, "Bend", {{node_target(5, "weights"), {0, 2}, "SCALAR", {0, 1}}});
    builder.tree["animations"][0]["channels"].push_back(
        {{"sampler", 1}, {"target", node_target(5, "weights")}});
    builder.tree["animations"][0]["samplers"].push_back(
        builder.tree["animations"][1]["samplers"][0]);
    const json tree = builder.finished();
    expect_sequence(tree);
    const Loaded loaded = load_at(tree, 1.0);
    EXPECT_EQ(loaded.scene->static_primitive_count, 1);
    EXPECT_EQ(loaded.scene->world_primitive_count, 2);
    EXPECT_EQ(loaded.scene->primitives[1].node, 5);
}

/// A node that appears and vanishes takes its instance along and leaves the geometry in place.
TEST(Sequence, HiddenNodesKeepTheirGeometry) {
    AssetBuilder builder = sliding_asset();
    builder.tree["extensionsUsed"] = {"KHR_node_visibility", "KHR_animation_pointer"};
    builder.tree["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = true;
    builder.tree["animations"].clear();
    const char* visible = "/nodes/1/extensions/KHR_node_visibility/visible";
    Movement blink{pointer_target(visible), {0, 1}, "SCALAR", {0, 1}, "STEP"};
    add_animation(builder, "Blink", {blink});
    const json tree = builder.finished();
    expect_sequence(tree);
    OpenAsset open(tree);
    Scene hidden = open.at(0.5);
    EXPECT_EQ(hidden.instances.size(), 1U) << "mesh 3 below node 4";
    EXPECT_EQ(hidden.info.triangles_in_world, 2U);
    const GeometryStamp mesh = hidden.meshes[0].stamp;
    open.asset->take_back(std::move(hidden));
    const Scene shown = open.at(1.5);
    EXPECT_EQ(shown.instances.size(), 3U);
    EXPECT_EQ(shown.meshes[0].stamp, mesh);
}

/// A node whose scale is 0 for a while is not drawn then, and its geometry stays.
TEST(Sequence, NodesMayGrowFromNothing) {
    AssetBuilder builder = sliding_asset();
    builder.tree["animations"].clear();
    add_animation(builder, "Grow", {{node_target(1, "scale"), {0, 2}, "VEC3", {0, 0, 0, 1, 1, 1}}});
    const json tree = builder.finished();
    expect_sequence(tree);
    EXPECT_EQ(load_at(tree, 0).scene->instances.size(), 1U);
    EXPECT_TRUE(load_at(tree, 0).warns("whose scale is zero"));
    EXPECT_EQ(load_at(tree, 1).scene->instances.size(), 3U);
}

/// A node flattened along one axis for a while is drawn all the same.
TEST(Sequence, NodesMayGrowFromAPlane) {
    AssetBuilder builder = sliding_asset();
    builder.tree["animations"].clear();
    add_animation(builder, "Grow", {{node_target(1, "scale"), {0, 2}, "VEC3", {1, 1, 0, 1, 1, 1}}});
    const json tree = builder.finished();
    expect_sequence(tree);
    const Loaded flat = load_at(tree, 0);
    EXPECT_TRUE(flat.warns("drawn flat")) << flat.warnings;
    EXPECT_EQ(flat.scene->info.triangles_in_world, load_at(tree, 1).scene->info.triangles_in_world);
}

/// Points on a sliding node are an instance only while a shutter is open, and start in place.
TEST(Sequence, PointsMoveWithTheirNodeWhileAShutterIsOpen) {
    AssetBuilder builder = sliding_asset();
    builder.tree["meshes"][2]["primitives"][0]["mode"] = 0;
    OpenAsset open(builder.finished());
    const Result<Scene> scene = open.asset->scene_between({0.5, 1.0}, true, open.log);
    ASSERT_TRUE(scene);
    ASSERT_EQ(scene->meshes.size(), 3U);
    const Instance& points = scene->instances.back();
    const auto index = static_cast<size_t>(scene->meshes[2].first_primitive);
    EXPECT_EQ(scene->primitives[index].geometry, static_cast<int32_t>(GeometryKind::spheres));
    EXPECT_EQ(points.mesh, 2);
    EXPECT_EQ(bytes_of(std::vector{points.world_from_object}), bytes_of(std::vector{Affinef{}}));
    ASSERT_TRUE(moves(points));
    EXPECT_EQ(scene->spheres[sphere_word(size_t{0})], 1.0F) << "in the world at the opening";
    const auto last = static_cast<size_t>(points.motion) + 8;
    EXPECT_FLOAT_EQ(scene->motion.instances[last].m[0][3], 1.0F);
    EXPECT_EQ(load_at(builder.finished(), 0.5).scene->world_primitive_count, 2);
}

/// Of all points and of the ends of all lines, without their radii.
std::vector<float> places(const Scene& scene) {
    std::vector<float> out;
    for (const Primitive& primitive : scene.primitives) {
        if (primitive.geometry != static_cast<int32_t>(GeometryKind::spheres)) continue;
        for (int32_t i = 0; i < primitive.triangle_count; ++i) {
            const float* at = &scene.spheres[sphere_word(
                static_cast<size_t>(primitive.first_triangle) + static_cast<size_t>(i))];
            out.insert(out.end(), {at[0], at[sphere_block], at[2 * sphere_block]});
        }
    }
    for (size_t i = 0; i < scene.curve_points.size(); i += 4) {
        const float* at = &scene.curve_points[i];
        out.insert(out.end(), {at[0], at[1], at[2]});
    }
    return out;
}

/// Every instance of points moves along: its mesh holds the positions at shutter open, its motion
/// gives the later ones.
TEST(Sequence, InstancedPointsAndLinesMoveWithTheirNode) {
    for (const int mode : {0, 1}) {
        AssetBuilder builder = sliding_asset();
        builder.tree["meshes"][2]["primitives"][0]["mode"] = mode;
        builder.tree["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
        const int t = builder.add_accessor("VEC3", 5126, F{0, 0, 0, 1, 2, 3, 0, 0, 9, 0, 0, 0});
        // The last is flat and shows nothing.
        const int s = builder.add_accessor("VEC3", 5126, F{1, 1, 1, 2, 3, 1, 1, 1, 1, 0, 0, 0});
        builder.tree["nodes"][2]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
            {"TRANSLATION", t}, {"SCALE", s}};
        const json tree = builder.finished();
        expect_sequence(tree);
        OpenAsset open(tree);
        const Result<Scene> scene = open.asset->scene_between({0.5, 1.0}, true, open.log);
        ASSERT_TRUE(scene);
        ASSERT_EQ(scene->meshes.size(), 3U);
        EXPECT_EQ(scene->meshes[2].primitive_count, 3);
        EXPECT_EQ(scene->world_primitive_count, 1) << "what stands still";
        ASSERT_TRUE(moves(scene->instances.back()));
        const auto last = static_cast<size_t>(scene->instances.back().motion) + 8;
        EXPECT_FLOAT_EQ(scene->motion.instances[last].m[0][3], 1.0F);
        // At a single time they lie in world space, at the same positions.
        const Loaded alone = load_at(tree, 0.5);
        EXPECT_EQ(places(*scene), places(*alone.scene));
        EXPECT_EQ(places(*scene).size(), mode == 0 ? 27U : 18U);
    }
}

}  // namespace
}  // namespace obscura::gltf
