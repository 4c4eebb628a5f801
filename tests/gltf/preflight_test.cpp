// tests/gltf/preflight_test.cpp - what tinygltf gets to read, and what it must never see.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/preflight.h"

#include "gltf/parse/model.h"

#include <gtest/gtest.h>

namespace obscura::gltf {
namespace {

using nlohmann::json;

/// A checked tree, with the document made so far.
struct Checked {
    explicit Checked(const char* text) : tree(json::parse(text)) {
        Log log(Verbosity::quiet);
        fault.file = "f";
        check_tree(tree, document, log, fault);
    }

    std::string id() const { return fault.error ? fault.error->id : ""; }
    std::string where() const { return fault.error ? fault.error->where : ""; }

    json tree;
    Document document;
    JsonFault fault;
};

/// All nodes, from their parts.
std::vector<tinygltf::Node> nodes_of(json& tree) {
    std::vector<tinygltf::Node> out;
    const auto add = [&](const std::vector<tinygltf::Node>& nodes, size_t first) {
        EXPECT_EQ(first, out.size());
        out.insert(out.end(), nodes.begin(), nodes.end());
        return true;
    };
    EXPECT_TRUE(read_model(tree, "f"));
    EXPECT_TRUE(read_node_parts(std::move(tree), "f", add));
    return out;
}

/// A tree that was not checked: tinygltf's own refusal is a fault of ours.
TEST(Preflight, WhatTinygltfRefusesIsAnInternalError) {
    json tree = json::parse(R"({"meshes": [5]})");
    const Result<tinygltf::Model> model = read_model(tree, "f");
    ASSERT_FALSE(model);
    EXPECT_EQ(model.error().id, "E-INTERNAL");
    EXPECT_EQ(model.error().code, ExitCode::internal);
    EXPECT_EQ(model.error().where, "f");
}

TEST(Preflight, DataAndPathsAreSetAside) {
    Checked checked(R"({"buffers": [{"byteLength": 9000000000, "uri": "../../etc/passwd"}],
                        "images": [{"uri": "/etc/passwd", "mimeType": "image/png"}]})");
    ASSERT_EQ(checked.id(), "");
    EXPECT_EQ(checked.tree.dump().find("passwd"), std::string::npos);
    EXPECT_EQ(checked.document.buffers.at(0).uri, "../../etc/passwd");
    EXPECT_EQ(checked.document.buffers.at(0).byte_length, 9000000000U);
    EXPECT_EQ(checked.document.images.at(0).uri, "/etc/passwd");
    const auto model = read_model(checked.tree, "f");
    ASSERT_TRUE(model);
    EXPECT_EQ(model->buffers.size(), 1U);
    EXPECT_EQ(model->buffers[0].data.size(), 1U);
    EXPECT_EQ(model->images.at(0).mimeType, "image/png");
}

TEST(Preflight, IntegersMayBeWrittenAsFractions) {
    Checked checked(R"({"nodes": [{"mesh": 0.0, "children": [1e0]}, {}],
                        "meshes": [{"primitives": []}]})");
    ASSERT_EQ(checked.id(), "");
    const std::vector<tinygltf::Node> nodes = nodes_of(checked.tree);
    ASSERT_EQ(nodes.size(), 2U);
    EXPECT_EQ(nodes[0].mesh, 0);
    EXPECT_EQ(nodes[0].children, std::vector<int>{1});
}

TEST(Preflight, ThousandsOfNodesKeepTheirOrder) {
    json tree;
    constexpr int count = 10000;
    for (int i = 0; i < count; ++i)
        tree["nodes"].push_back({{"name", std::to_string(i)}});
    const std::vector<tinygltf::Node> nodes = nodes_of(tree);
    ASSERT_EQ(nodes.size(), static_cast<size_t>(count));
    for (int i = 0; i < count; ++i)
        ASSERT_EQ(nodes[static_cast<size_t>(i)].name, std::to_string(i));
}

TEST(Preflight, AccessorsMayHaveNoData) {
    Checked checked(R"({"buffers": [{"byteLength": 8}],
        "bufferViews": [{"buffer": 0, "byteLength": 8}],
        "accessors": [{"componentType": 5123, "count": 3, "type": "SCALAR"},
                      {"bufferView": 0, "componentType": 5123, "count": 3, "type": "SCALAR"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0}]}]})");
    ASSERT_EQ(checked.id(), "");
    const auto model = read_model(checked.tree, "f");
    ASSERT_TRUE(model) << model.error().message;
    EXPECT_EQ(model->accessors.at(0).bufferView, -1);
    EXPECT_EQ(model->accessors.at(1).bufferView, 0);
    EXPECT_EQ(model->bufferViews.size(), 1U);
}

TEST(Preflight, ChannelsWithoutANodeAreNotLost) {
    Checked checked(R"({"nodes": [{}], "animations": [{"channels": [
        {"sampler": 0, "target": {"path": "scale"}},
        {"sampler": 1, "target": {"extensions": {"KHR_animation_pointer": {"pointer": "/x"}}}},
        {"sampler": 2, "target": {"node": 0, "path": "scale"}}]}]})");
    ASSERT_EQ(checked.id(), "");
    const auto model = read_model(checked.tree, "f");
    ASSERT_TRUE(model);
    const auto& channels = model->animations.at(0).channels;
    ASSERT_EQ(channels.size(), 3U);
    EXPECT_EQ(channels[0].target_node, -1);
    EXPECT_EQ(channels[1].target_node, -1);
    EXPECT_EQ(channels[1].target_extensions.count("KHR_animation_pointer"), 1U);
    EXPECT_EQ(channels[2].target_node, 0);
    EXPECT_EQ(channels[2].target_path, "scale");
}

TEST(Preflight, WhatNobodyReadsIsTakenOut) {
    Checked checked(R"({"nodes": [{"extensions": {"KHR_audio": {"emitter": "x"},
                                                  "KHR_node_visibility": {"visible": true}}}],
                        "extensions": {"KHR_audio": {"sources": 5}}})");
    ASSERT_EQ(checked.id(), "");
    EXPECT_EQ(checked.tree.dump().find("KHR_audio"), std::string::npos);
    EXPECT_TRUE(checked.tree["nodes"][0]["extensions"].contains("KHR_node_visibility"));
}

TEST(Preflight, FaultsHaveTheirPlaces) {
    struct Case {
        const char* text;
        const char* id;
        const char* where;
    };
    const Case cases[] = {
        {R"({"meshes": [{"primitives": [{"attributes": {"A/B": 0}}]}]})",
         "E-DOC-INDEX",
         "f#/meshes/0/primitives/0/attributes/A~1B"},
        {R"({"meshes": [{"primitives": [{"attributes": {}, "targets": [{}, 5]}]}]})",
         "E-JSON-TYPE",
         "f#/meshes/0/primitives/0/targets/1"},
        {R"({"nodes": [{"extensions": []}]})", "E-JSON-TYPE", "f#/nodes/0/extensions"},
        {R"({"nodes": [{"extensions": {"OBSCURA_shape": 1}}]})",
         "E-JSON-TYPE",
         "f#/nodes/0/extensions/OBSCURA_shape"},
        {R"({"materials": [{"pbrMetallicRoughness": {"baseColorTexture": {}}}]})",
         "E-DOC-MISSING",
         "f#/materials/0/pbrMetallicRoughness/baseColorTexture"},
        {R"({"extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": 1}]}}})",
         "E-JSON-TYPE",
         "f#/extensions/KHR_lights_punctual/lights/0/spot"},
        {R"({"animations": [{"channels": [
            {"sampler": 0, "target": {"node": 0, "path": "scale"}}]}]})",
         "E-DOC-INDEX",
         "f#/animations/0/channels/0/target/node"},
        {R"({"cameras": [{"type": "perspective", "perspective":
            {"yfov": 1, "znear": 1, "zfar": 0}}]})",
         "E-CAM-CLIP",
         "f#/cameras/0/perspective/zfar"}};
    for (const Case& c : cases) {
        const Checked checked(c.text);
        EXPECT_EQ(checked.id(), c.id) << c.text;
        EXPECT_EQ(checked.where(), c.where) << c.text;
    }
}

}  // namespace
}  // namespace obscura::gltf
