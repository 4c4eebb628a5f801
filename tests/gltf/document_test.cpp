// tests/gltf/document_test.cpp - a table of broken assets and the error of each (B, C, E, G).
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/document.h"

#include "gltf/gltf_files.h"

#include <gtest/gtest.h>

namespace obscura::gltf {
namespace {

using namespace test;

/// A sound asset (see sound_asset) with some values replaced.
struct Fault {
    const char* name;
    const char* patch;  ///< {"/json/pointer": new value, ...}; null removes the member
    int code;
    const char* id;
    const char* where;  ///< end of Error::where
};

void PrintTo(const Fault& fault, std::ostream* out) {
    *out << fault.name;
}

/// The triangle with a child node, a sparse accessor (4), a camera and a light.
json sound_asset() {
    AssetBuilder builder = triangle_builder();
    json sparse = {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}};
    sparse["sparse"] = {
        {"count", 2},
        {"indices",
         {{"bufferView", builder.add_view(std::string("\0\1 \0", 4))}, {"componentType", 5121}}},
        {"values", {{"bufferView", builder.add_view(std::string(24, '\0'))}}}};
    builder.tree["accessors"].push_back(sparse);
    json& tree = builder.tree;
    tree["nodes"][0]["children"] = {1};
    tree["nodes"].push_back({{"camera", 0}});
    tree["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    tree["scene"] = 0;
    tree["cameras"][0] = {{"type", "perspective"},
                          {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}};
    tree["cameras"][1] = {{"type", "orthographic"},
                          {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 9}}}};
    tree["extensions"]["KHR_lights_punctual"]["lights"][0]["type"] = "point";
    tree["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
    tree["textures"][0]["sampler"] = 0;
    tree["samplers"][0] = json::object();
    return builder.finished();
}

constexpr Fault faults[] = {
    // B: JSON values
    {"B8_fraction", R"({"/nodes/0/mesh": 0.5})", 65, "E-JSON-TYPE", "#/nodes/0/mesh"},
    {"B8_negative", R"({"/nodes/0/mesh": -1})", 65, "E-JSON-TYPE", "#/nodes/0/mesh"},
    {"B8_index_2_31", R"({"/nodes/0/mesh": 2147483648})", 65, "E-DOC-INDEX", "/nodes/0/mesh"},
    {"B8_size_2_53", R"({"/accessors/0/count": 1e17})", 65, "E-JSON-TYPE", "/accessors/0/count"},
    {"B9_string_as_number", R"({"/accessors/0/count": "3"})", 65, "E-JSON-TYPE", "0/count"},
    {"B9_null_array", R"({"/meshes/0/primitives": "null"})", 65, "E-JSON-TYPE", "/primitives"},
    {"B9_nodes_object", R"({"/nodes": {}})", 65, "E-JSON-TYPE", "#/nodes"},
    {"B9_node_number", R"({"/nodes/1": 5})", 65, "E-JSON-TYPE", "#/nodes/1"},
    {"B10_no_asset", R"({"/asset": null})", 65, "E-DOC-MISSING", "#"},
    {"B10_no_version", R"({"/asset/version": null})", 65, "E-DOC-MISSING", "#/asset"},
    {"B10_odd_version", R"({"/asset/version": "two"})", 65, "E-DOC-VERSION", "/asset/version"},
    {"B10_version_1", R"({"/asset/version": "1.0"})", 69, "E-VERSION", "#/asset"},
    {"B10_version_3", R"({"/asset/version": "3.0"})", 69, "E-VERSION", "#/asset"},
    {"B10_min_version", R"({"/asset/minVersion": "2.9"})", 69, "E-VERSION", "#/asset"},
    {"B14_scene_number", R"({"/scene": 1})", 65, "E-DOC-INDEX", "#/scene"},
    // C: accessors and buffers
    {"C1_view_past_end", R"({"/bufferViews/3/byteLength": 9999})", 65, "E-BUF-RANGE", "ws/3"},
    {"C1_view_offset_past_end",
     R"({"/bufferViews/3/byteOffset": 99999})",
     65,
     "E-BUF-RANGE",
     "ws/3"},
    {"C1_view_wraps",
     R"({"/bufferViews/3/byteOffset": 9007199254740992,
         "/bufferViews/3/byteLength": 9007199254740992})",
     65,
     "E-BUF-RANGE",
     "ws/3"},
    {"C1_view_length_0", R"({"/bufferViews/3/byteLength": 0})", 65, "E-BUF-LENGTH", "byteLength"},
    {"C1_no_buffer", R"({"/bufferViews/3/buffer": 1})", 65, "E-DOC-INDEX", "/3/buffer"},
    {"C2_accessor_past_view", R"({"/accessors/0/count": 4})", 65, "E-ACC-RANGE", "accessors/0"},
    {"C2_offset_past_view", R"({"/accessors/0/byteOffset": 4})", 65, "E-ACC-RANGE", "accessors/0"},
    {"C2_offset_wraps",
     R"({"/accessors/0/byteOffset": 9007199254740992})",
     65,
     "E-ACC-RANGE",
     "s/0"},
    {"C3_count_0", R"({"/accessors/0/count": 0})", 65, "E-ACC-COUNT", "/accessors/0/count"},
    {"C4_count_2_53", R"({"/accessors/0/count": 9007199254740992})", 65, "E-ACC-RANGE", "s/0"},
    {"C4_zeros_2_53",
     R"({"/accessors/0/count": 9007199254740992, "/accessors/0/bufferView": null})",
     77,
     "E-LIMIT-VERTICES",
     "/meshes/0/primitives/0"},
    {"C4_zeros_2_28",
     R"({"/accessors/0/count": 268435456, "/accessors/0/bufferView": null,
         "/accessors/0/min": null})",
     77,
     "E-LIMIT-COUNT",
     "/accessors/0/count"},
    {"C5_stride_too_small", R"({"/bufferViews/0/byteStride": 8})", 65, "E-ACC-RANGE", "s/0"},
    {"C5_stride_256", R"({"/bufferViews/0/byteStride": 256})", 65, "E-BUF-STRIDE", "byteStride"},
    {"C5_stride_odd", R"({"/bufferViews/0/byteStride": 13})", 65, "E-BUF-STRIDE", "byteStride"},
    {"C5_stride_0", R"({"/bufferViews/0/byteStride": 0})", 65, "E-BUF-STRIDE", "byteStride"},
    {"C7_sparse_count", R"({"/accessors/4/sparse/count": 4})", 65, "E-ACC-SPARSE", "sparse/count"},
    {"C7_sparse_count_0", R"({"/accessors/4/sparse/count": 0})", 65, "E-ACC-SPARSE", "count"},
    {"C7_sparse_index",
     R"({"/accessors/4/sparse/indices/byteOffset": 1,
         "/meshes/0/primitives/0/attributes/POSITION": 4})",
     65,
     "E-ACC-SPARSE",
     "#/accessors/4"},
    {"C8_sparse_indices_past_end",
     R"({"/accessors/4/sparse/indices/byteOffset": 3})",
     65,
     "E-ACC-RANGE",
     "#/accessors/4"},
    {"C8_sparse_values_past_end",
     R"({"/accessors/4/sparse/values/byteOffset": 4})",
     65,
     "E-ACC-RANGE",
     "#/accessors/4"},
    {"C8_sparse_type",
     R"({"/accessors/4/sparse/indices/componentType": 5126})",
     65,
     "E-ACC-TYPE",
     "componentType"},
    {"C10_index_too_large",
     R"({"/accessors/3/bufferView": 4, "/accessors/3/componentType": 5121})",
     65,
     "E-MESH-INDEX",
     "/primitives/0"},
    {"C14_counts_differ",
     R"({"/accessors/1/count": 2})",
     65,
     "E-MESH-COUNT",
     "#/meshes/0/primitives/0"},
    {"C15_component_type", R"({"/accessors/0/componentType": 5124})", 65, "E-ACC-TYPE", "Type"},
    {"C15_type", R"({"/accessors/0/type": "VEC5"})", 65, "E-ACC-TYPE", "/accessors/0/type"},
    {"C15_position_vec2",
     R"({"/meshes/0/primitives/0/attributes/POSITION": 2})",
     65,
     "E-MESH-ATTRIBUTE",
     "es/0"},
    {"C15_normal_vec2",
     R"({"/meshes/0/primitives/0/attributes/NORMAL": 2})",
     65,
     "E-MESH-ATTRIBUTE",
     "es/0"},
    {"C15_short_position_unasked",
     R"({"/accessors/0/componentType": 5122})",
     65,
     "E-MESH-ATTRIBUTE",
     "primitives/0"},
    {"C15_float_indices", R"({"/meshes/0/primitives/0/indices": 0})", 65, "E-ACC-TYPE", "ors/0"},
    {"C15_signed_indices", R"({"/accessors/3/componentType": 5122})", 65, "E-ACC-TYPE", "ors/3"},
    {"C15_mode_7", R"({"/meshes/0/primitives/0/mode": 7})", 65, "E-MESH-MODE", "/mode"},
    {"C15_no_attributes",
     R"({"/meshes/0/primitives/0/attributes": null})",
     65,
     "E-DOC-MISSING",
     "/primitives/0"},
    {"C19_bad_base64",
     R"({"/buffers/0/uri": "data:application/octet-stream;base64,A*"})",
     65,
     "E-URI-DATA",
     "uri"},
    {"C19_short_data",
     R"({"/buffers/0/uri": "data:application/octet-stream;base64,AAAA"})",
     65,
     "E-BUF-LENGTH",
     "s/0"},
    {"C19_unknown_mime",
     R"({"/buffers/0/uri": "data:text/html;base64,AAAA"})",
     65,
     "E-URI-DATA",
     "buffers/0/uri"},
    {"A11_no_source", R"({"/buffers/0/uri": null})", 65, "E-BUF-SOURCE", "#/buffers/0"},
    {"D13_uri_and_view",
     R"({"/images": [{"uri": "a.png", "bufferView": 0}]})",
     65,
     "E-DOC-IMAGE",
     "#/images/0"},
    {"F4_texture_index",
     R"({"/materials/0/pbrMetallicRoughness/baseColorTexture/index": 1})",
     65,
     "E-DOC-INDEX",
     "index"},
    {"sampler_value", R"({"/samplers/0/wrapS": 1})", 65, "E-DOC-SAMPLER", "#/samplers/0/wrapS"},
    // E: nodes
    {"E1_self", R"({"/nodes/0/children": [0]})", 65, "E-NODE-CYCLE", "#/nodes/0"},
    {"E1_two", R"({"/nodes/1/children": [0]})", 65, "E-NODE-CYCLE", "#/nodes/1"},
    {"E2_two_parents", R"({"/nodes/2/children": [1]})", 65, "E-NODE-PARENTS", "/2/children"},
    {"E2_child_twice", R"({"/nodes/0/children": [1, 1]})", 65, "E-NODE-PARENTS", "/0/children"},
    {"E9_zero_quaternion",
     R"({"/nodes/0/rotation": [0, 0, 0, 0]})",
     65,
     "E-NODE-ROTATION",
     "#/nodes/0/rotation"},
    {"E11_mesh_index", R"({"/nodes/0/mesh": 1})", 65, "E-DOC-INDEX", "#/nodes/0/mesh"},
    {"E_child_index", R"({"/nodes/0/children": [9]})", 65, "E-DOC-INDEX", "/0/children"},
    {"E_scene_node_index", R"({"/scenes/0/nodes": [3]})", 65, "E-DOC-INDEX", "/scenes/0/nodes"},
    {"E_too_far", R"({"/nodes/0/translation": [1e30, 0, 0]})", 65, "E-NODE-RANGE", "#/nodes/0"},
    // F, G: cameras and lights
    {"light_type",
     R"({"/extensions/KHR_lights_punctual/lights/0/type": "area"})",
     65,
     "E-LIGHT-TYPE",
     "type"},
    {"light_index",
     R"({"/nodes/2/extensions/KHR_lights_punctual/light": 1})",
     65,
     "E-DOC-INDEX",
     "/light"},
    {"G3_yfov_0", R"({"/cameras/0/perspective/yfov": 0})", 65, "E-CAM-FOV", "/yfov"},
    {"G3_yfov_negative", R"({"/cameras/0/perspective/yfov": -1})", 65, "E-CAM-FOV", "/yfov"},
    {"G3_yfov_pi", R"({"/cameras/0/perspective/yfov": 3.15})", 65, "E-CAM-FOV", "/yfov"},
    {"G4_aspect_0",
     R"({"/cameras/0/perspective/aspectRatio": 0})",
     65,
     "E-CAM-ASPECT",
     "/aspectRatio"},
    {"G5_near_0", R"({"/cameras/0/perspective/znear": 0})", 65, "E-CAM-CLIP", "/znear"},
    {"G5_far_before_near", R"({"/cameras/0/perspective/zfar": 0.05})", 65, "E-CAM-CLIP", "/zfar"},
    {"G6_xmag_0", R"({"/cameras/1/orthographic/xmag": 0})", 65, "E-CAM-MAG", "/xmag"},
    {"G_type", R"({"/cameras/1/type": "fisheye"})", 65, "E-CAM-TYPE", "/cameras/1/type"},
    {"G8_singular",
     R"({"/nodes/0/matrix": [0,0,0,0, 0,0,0,0, 0,0,0,0, 0,0,0,1]})",
     65,
     "E-CAM-MATRIX",
     "#/nodes/1"},
};

json patched(const char* patch) {
    json tree = sound_asset();
    const json changes = json::parse(patch);
    for (const auto& [pointer, value] : changes.items()) {
        const json::json_pointer place(pointer);
        if (value.is_null()) {
            tree[place.parent_pointer()].erase(place.back());
        } else {
            tree[place] = value == "null" ? json() : value;
        }
    }
    return tree;
}

class BrokenAsset : public testing::TestWithParam<Fault> {};

TEST_P(BrokenAsset, IsRefusedWithItsReason) {
    const Loaded loaded = load_tree(patched(GetParam().patch));
    ASSERT_FALSE(loaded.scene);
    EXPECT_EQ(loaded.code(), GetParam().code) << loaded.text();
    EXPECT_EQ(loaded.id(), GetParam().id) << loaded.text();
    const std::string end = GetParam().where;
    const std::string& where = loaded.scene.error().where;
    EXPECT_NE(where.find("scene.gltf#"), std::string::npos) << where;
    ASSERT_GE(where.size(), end.size());
    EXPECT_EQ(where.substr(where.size() - end.size()), end) << where;
    EXPECT_GT(loaded.scene.error().message.size(), 10U);
}

INSTANTIATE_TEST_SUITE_P(Faults, BrokenAsset, testing::ValuesIn(faults), [](const auto& row) {
    return std::string(row.param.name);
});

TEST(Document, TheSoundAssetLoads) {
    const Loaded loaded = load_tree(sound_asset());
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.scene->indices.size(), 3U + 1);
}

TEST(Document, ACycleIsListed) {
    AssetBuilder builder = triangle_builder();
    for (int i = 1; i < 5; ++i) {
        builder.tree["nodes"].push_back(
            {{"name", "n" + std::to_string(i)}, {"children", {i == 4 ? 2 : i + 1}}});
    }
    builder.tree["nodes"][1]["children"] = json::array();
    const Loaded loaded = load_tree(builder.finished());
    EXPECT_EQ(loaded.id(), "E-NODE-CYCLE");
    for (const char* name : {"\"n2\"", "\"n3\"", "\"n4\""}) {
        EXPECT_NE(loaded.text().find(name), std::string::npos) << loaded.text();
    }
}

/// Oddities that are drawn all the same.
struct Oddity {
    const char* name;
    const char* patch;
    const char* warning;
};

void PrintTo(const Oddity& oddity, std::ostream* out) {
    *out << oddity.name;
}

constexpr Oddity oddities[] = {
    {"C6_misaligned",
     R"({"/accessors/1/byteOffset": 2, "/accessors/1/count": 2, "/accessors/1/bufferView": 0,
         "/meshes/0/primitives/0/attributes/NORMAL": null})",
     "multiple of their component's size: /accessors/1"},
    {"C18_missing_bounds", R"({"/accessors/0/min": null})", "no min and max"},
    {"C18_wrong_bounds", R"({"/accessors/0/max": [1, 1, 0]})", "do not hold the vertices"},
    {"E5_child_as_root", R"({"/scenes/0/nodes": [0, 1]})", "not a root node"},
    {"E8_matrix_and_scale",
     R"({"/nodes/0/matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1], "/nodes/0/scale": [2, 2, 2]})",
     "the matrix counts"},
    {"E_last_row", R"({"/nodes/0/matrix": [1,0,0,1, 0,1,0,0, 0,0,1,0, 0,0,0,1]})", "last row"},
    {"E10_far_away", R"({"/nodes/0/translation": [1e7, 0, 0]})", "lose precision"},
    {"F3_metallic", R"({"/materials/0/pbrMetallicRoughness/metallicFactor": 7})", "metallicFactor"},
    {"F8_alpha_mode", R"({"/materials/0/alphaMode": "SOFT"})", "OPAQUE is used"},
    {"F8_cutoff", R"({"/materials/0/alphaCutoff": -1})", "alphaCutoff"},
    {"F9_intensity", R"({"/extensions/KHR_lights_punctual/lights/0/intensity": -1})", "intensity"},
    {"F9_range", R"({"/extensions/KHR_lights_punctual/lights/0/range": 0})", "unlimited"},
    {"G6_negative_xmag", R"({"/cameras/1/orthographic/xmag": -2})", "absolute value"},
    {"mode_without_triangle", R"({"/accessors/3/count": 2})", "do not make a triangle"},
};

class OddAsset : public testing::TestWithParam<Oddity> {};

TEST_P(OddAsset, LoadsWithAWarning) {
    const Loaded loaded = load_tree(patched(GetParam().patch));
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_TRUE(loaded.warns(GetParam().warning)) << loaded.warnings;
}

INSTANTIATE_TEST_SUITE_P(Oddities, OddAsset, testing::ValuesIn(oddities), [](const auto& row) {
    return std::string(row.param.name);
});

}  // namespace
}  // namespace obscura::gltf
