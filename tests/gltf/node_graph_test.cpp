// tests/gltf/node_graph_test.cpp - deep and wide trees, transforms, and what makes one singular.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/node_graph.h"

#include "gltf/gltf_files.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <gmock/gmock.h>

namespace obscura::gltf {
namespace {

using namespace test;

Affined scaling(double x, double y, double z) {
    Affined out;
    out.m[0][0] = x;
    out.m[1][1] = y;
    out.m[2][2] = z;
    return out;
}

TEST(NodeGraph, SingularMeansFlatNotSmall) {  // E6
    EXPECT_FALSE(is_singular(Affined{}));
    EXPECT_FALSE(is_singular(scaling(1e-12, 1e-12, 1e-12)));
    EXPECT_FALSE(is_singular(scaling(1e9, 1e-9, -1)));
    EXPECT_TRUE(is_singular(scaling(1, 1, 0)));
    EXPECT_TRUE(is_singular(scaling(0, 0, 0)));
    EXPECT_TRUE(is_singular(scaling(INFINITY, 1, 1)));
    Affined parallel;
    parallel.m[0][1] = 1;
    parallel.m[1][1] = 0;
    EXPECT_TRUE(is_singular(parallel));
    Affined lost;
    lost.m[1][3] = NAN;
    EXPECT_TRUE(is_singular(lost));
}

TEST(NodeGraph, FlatteningLeavesAnArea) {
    EXPECT_FALSE(is_flattening(Affined{}));
    EXPECT_FALSE(is_flattening(scaling(1e-9, 1e-9, 1e-9)));
    EXPECT_FALSE(is_flattening(scaling(0, 0, 1)));
    EXPECT_FALSE(is_flattening(scaling(0, 0, 0)));
    for (const Affined& flat :
         {scaling(0, 1, 1), scaling(1, 0, 1), scaling(1, -1, 0), scaling(1e-6, 1e6, 0)})
        EXPECT_TRUE(is_flattening(flat));
    Affined parallel;  // x and y fall on one line, z beside it
    parallel.m[0][1] = 1;
    parallel.m[1][1] = 0;
    EXPECT_TRUE(is_flattening(parallel));
    parallel.m[0][2] = 5;
    parallel.m[2][2] = 0;
    EXPECT_FALSE(is_flattening(parallel));
    EXPECT_FALSE(is_flattening(scaling(INFINITY, 0, 0)));
}

TEST(NodeGraph, NearlyFlatMeansOneAxisBesideAnother) {
    EXPECT_FALSE(is_nearly_flat(Affined{}));
    EXPECT_FALSE(is_nearly_flat(scaling(1e-30, 1e-30, 1e-30)));
    EXPECT_FALSE(is_nearly_flat(scaling(1e6, 1, 1e-5)));
    EXPECT_TRUE(is_nearly_flat(scaling(1000, 1000, 1e-15)));
    EXPECT_TRUE(is_nearly_flat(scaling(1e-15, 1, -1)));
    EXPECT_FALSE(is_nearly_flat(scaling(1, 1, 0)));  // that is flat
    EXPECT_FALSE(is_nearly_flat(scaling(INFINITY, 1, 1)));
}

/// A chain of nodes, each moved by (1, 0, 0) from its parent; the mesh hangs on the last.
Document chain(int length) {
    Document document;
    document.nodes.resize(static_cast<size_t>(length));
    for (int i = 0; i < length; ++i) {
        GltfNode& node = document.nodes[static_cast<size_t>(i)];
        node.parent_from_node.m[0][3] = 1;
        if (i + 1 < length) node.children = {i + 1};
    }
    document.scenes.push_back({"s", {0}});
    return document;
}

TEST(NodeGraph, AMillionDeepIsPlaced) {  // E3
    const Document document = chain(1000000);
    Log log(Verbosity::quiet);
    ASSERT_TRUE(check_node_graph(document));
    const std::vector<PlacedNode> placed = place_nodes(document, 0, log);
    ASSERT_EQ(placed.size(), 1000000U);
    EXPECT_EQ(placed.back().world_from_node.m[0][3], 1000000.0);
}

TEST(NodeGraph, ALongCycleIsFoundInLinearTime) {
    Document document = chain(1000000);
    document.nodes.back().children = {500000};
    document.nodes[499999].children.clear();
    const Result<void> checked = check_node_graph(document);
    ASSERT_FALSE(checked);
    EXPECT_EQ(checked.error().id, "E-NODE-CYCLE");
    EXPECT_LT(checked.error().message.size(), 1000U);
}

TEST(NodeGraph, TheFileIsReadInLinearTime) {
    AssetBuilder builder = triangle_builder();
    std::string nodes = R"({"mesh":0,"children":[1]})";
    constexpr int count = 200000;
    for (int i = 1; i < count; ++i) {
        nodes += R"(,{"name":"n","translation":[0,1,0])";
        nodes += i + 1 < count ? ",\"children\":[" + std::to_string(i + 1) + "]}" : "}";
    }
    builder.tree["nodes"] = "NODES";
    std::string text = builder.finished().dump();
    text.replace(text.find("\"NODES\""), 7, "[" + nodes + "]");
    const auto start = std::chrono::steady_clock::now();
    const Loaded loaded = load_bytes(text);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.scene->info.node_names.size(), static_cast<size_t>(count));
    EXPECT_LT(taken.count(), 20.0);  // 0.4 s alone on a core; quadratic would take minutes
}

TEST(NodeGraph, PlacesInDepthFirstOrderAndOnlyTheScene) {
    Document document;
    document.nodes.resize(6);
    document.nodes[0].children = {2, 1};
    document.nodes[2].children = {3};
    document.scenes = {{"a", {4, 0}}, {"b", {5}}};
    Log log(Verbosity::quiet);
    std::vector<int> order;
    for (const PlacedNode& place : place_nodes(document, 0, log))
        order.push_back(place.node);
    EXPECT_EQ(order, (std::vector<int>{4, 0, 2, 3, 1}));
    order.clear();
    for (const PlacedNode& place : place_nodes(document, -1, log))
        order.push_back(place.node);
    EXPECT_EQ(order, (std::vector<int>{0, 2, 3, 1, 4, 5}));
    EXPECT_TRUE(log.warnings().empty());
}

TEST(NodeGraph, AChildListedAsRootIsDrawnOnceBelowItsParent) {  // E5
    Document document;
    document.nodes.resize(3);
    document.nodes[0].children = {1};
    document.nodes[0].parent_from_node.m[0][3] = 7;
    document.scenes = {{"a", {1, 0, 0, 2}}};
    Log log(Verbosity::quiet);
    const std::vector<PlacedNode> placed = place_nodes(document, 0, log);
    ASSERT_EQ(placed.size(), 3U);
    EXPECT_EQ(placed[1].node, 1);
    EXPECT_EQ(placed[1].world_from_node.m[0][3], 7.0);
    EXPECT_EQ(log.warnings().size(), 1U);
}

/// World position of (1, 2, 3) in a node of a tree given by JSON.
std::vector<float> moved_point(const json& node) {
    AssetBuilder builder;
    builder.add_accessor("VEC3", 5126, std::vector<float>{1, 2, 3, 2, 2, 3, 1, 3, 3});
    builder.add_mesh({{"attributes", {{"POSITION", 0}}}});
    json root = node;
    root["mesh"] = 0;
    builder.add_root(root);
    const Loaded loaded = load_tree(builder.finished());
    return loaded.scene ? position_of(*loaded.scene, 0) : std::vector<float>{};
}

TEST(NodeGraph, TransformsAreTranslationTimesRotationTimesScale) {
    const double half = std::sqrt(0.5);
    // A quarter turn around Z takes X to Y.
    EXPECT_THAT(moved_point({{"translation", {10, 20, 30}},
                             {"rotation", {0, 0, half, half}},
                             {"scale", {2, 3, 4}}}),
                testing::Pointwise(testing::FloatNear(1e-5f), {10 - 6.0f, 20 + 2.0f, 30 + 12.0f}));
    // E9: length 2 is the same rotation.
    EXPECT_THAT(moved_point({{"rotation", {0, 0, 2 * half, 2 * half}}}),
                testing::Pointwise(testing::FloatNear(1e-5f), {-2.0f, 1.0f, 3.0f}));
    // Columns: X to Y, Y to Z, Z to X, and a translation.
    EXPECT_EQ(moved_point({{"matrix", {0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 5, 6, 7, 1}}}),
              (std::vector<float>{3 + 5, 1 + 6, 2 + 7}));
}

/// Five triangles at x = 0, 10, 20 ... and a light and a camera on node 1.
json row_of_nodes() {
    json tree = triangle_asset();
    tree["extensions"]["KHR_lights_punctual"]["lights"][0]["type"] = "point";
    tree["cameras"][0] = {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}};
    for (int i = 0; i < 5; ++i)
        tree["nodes"][static_cast<size_t>(i)] = {{"mesh", 0}, {"translation", {10 * i, 0, 0}}};
    tree["nodes"][1]["camera"] = 0;
    tree["nodes"][1]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    tree["scenes"][0]["nodes"] = {0, 1, 2, 3, 4};
    return tree;
}

/// The nodes that are drawn.
std::vector<int> drawn(const Loaded& loaded) {
    EXPECT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.warnings, "");
    std::vector<int> out;
    for (const Instance& instance : loaded.scene->instances)
        out.push_back(instance.node);
    for (int i = 0; i < loaded.scene->world_primitive_count; ++i)
        out.push_back(loaded.scene->primitives[static_cast<size_t>(i)].node);
    return out;
}

TEST(NodeGraph, HiddenNodesAndWhatHangsOnThemAreNotDrawn) {
    json tree = row_of_nodes();
    const char* name = "KHR_node_visibility";
    tree["nodes"][0]["children"] = {1, 2};
    tree["scenes"][0]["nodes"] = {0, 3, 4};
    tree["nodes"][2]["extensions"][name]["visible"] = true;
    EXPECT_EQ(drawn(load_tree(tree)), (std::vector<int>{0, 1, 2, 3, 4}));
    EXPECT_EQ(load_tree(tree).scene->lights.size(), 1U);
    tree["nodes"][0]["extensions"][name]["visible"] = false;
    tree["nodes"][3]["extensions"][name] = json::object();
    const Loaded hidden = load_tree(tree);
    EXPECT_EQ(drawn(hidden), (std::vector<int>{3, 4}));
    EXPECT_EQ(hidden.scene->lights.size(), 0U);
    EXPECT_EQ(hidden.scene->cameras.size(), 1U) << "cameras do not hide";
    tree["nodes"][3]["extensions"][name]["visible"] = "no";
    EXPECT_EQ(load_tree(tree).id(), "E-JSON-TYPE");
}

TEST(NodeGraph, OnlyTheFinestLevelOfDetailIsDrawn) {
    json tree = row_of_nodes();
    tree["nodes"][0]["extensions"]["MSFT_lod"]["ids"] = {2, 3};
    tree["nodes"][2]["children"] = {4};
    tree["scenes"][0]["nodes"] = {0, 1, 2, 3};
    EXPECT_EQ(drawn(load_tree(tree)), (std::vector<int>{0, 1}));
    tree["nodes"][0]["extensions"]["MSFT_lod"]["ids"] = {0};
    EXPECT_EQ(drawn(load_tree(tree)), (std::vector<int>{0, 1, 2, 4, 3}));
    tree["nodes"][0]["extensions"]["MSFT_lod"]["ids"] = {5};
    EXPECT_EQ(load_tree(tree).id(), "E-DOC-INDEX");
}

}  // namespace
}  // namespace obscura::gltf
