// tests/gltf/document_meshopt_test.cpp - whole assets whose views are compressed, good and bad.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/gltf_files.h"
#include "gltf/meshopt_encode.h"

#include <gtest/gtest.h>

namespace obscura::gltf {
namespace {

using namespace test;

/// The triangle, each of its views compressed, above a buffer that has no data.
json compressed_triangle(const std::string& extension) {
    const AssetBuilder plain = triangle_builder();
    AssetBuilder out;
    json tree = plain.tree;
    for (size_t i = 0; i < 4; ++i) {
        json& view = tree["bufferViews"][i];
        const size_t offset = view["byteOffset"];
        const size_t stride = i == 3 ? 2 : i == 2 ? 8 : 12;
        const std::string data = plain.bytes.substr(offset, view["byteLength"].get<size_t>());
        const int number =
            out.add_view(i == 3 ? encode_triangles({0, 1, 2}) : encode_attributes(data, stride));
        const json& compressed = out.tree["bufferViews"][static_cast<size_t>(number)];
        view["buffer"] = 1;
        view["extensions"][extension] = {{"buffer", 0},
                                         {"byteOffset", compressed["byteOffset"]},
                                         {"byteLength", compressed["byteLength"]},
                                         {"byteStride", stride},
                                         {"count", 3},
                                         {"mode", i == 3 ? "TRIANGLES" : "ATTRIBUTES"}};
    }
    tree["buffers"] = out.finished()["buffers"];
    tree["buffers"].push_back({{"byteLength", plain.bytes.size()}});
    tree["extensionsRequired"] = {extension};
    return tree;
}

TEST(DocumentMeshopt, AssetsWithoutFallbackAreTheUncompressedOnes) {
    const Loaded plain = load_tree(triangle_asset());
    for (const char* extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
        json tree = compressed_triangle(extension);
        for (const bool tagged : {false, true}) {
            if (tagged) tree["buffers"][1]["extensions"][extension]["fallback"] = true;
            const Loaded loaded = load_tree(tree);
            ASSERT_TRUE(loaded.scene) << loaded.text();
            EXPECT_EQ(loaded.warnings, "");
            EXPECT_EQ(loaded.scene->positions, plain.scene->positions);
            EXPECT_EQ(loaded.scene->indices, plain.scene->indices);
            EXPECT_EQ(loaded.scene->attributes, plain.scene->attributes);
        }
    }
}

/// The content of the fallback's file does not matter: it is never opened.
TEST(DocumentMeshopt, FallbackFilesAreNotRead) {
    json tree = compressed_triangle("EXT_meshopt_compression");
    tree["buffers"][1]["uri"] = "absent.bin";
    EXPECT_TRUE(load_tree(tree).scene) << load_tree(tree).text();
    tree["bufferViews"][0].erase("extensions");
    EXPECT_EQ(load_tree(tree).id(), "E-RES-MISSING");
    tree["buffers"][1].erase("uri");
    EXPECT_EQ(load_tree(tree).id(), "E-BUF-SOURCE");
}

TEST(DocumentMeshopt, WrongLayoutsAreErrorsWithTheirPlace) {
    const std::string name = "EXT_meshopt_compression";
    struct Case {
        const char* key;
        json value;
        const char* id;
    };
    for (const Case& c : {Case{"mode", "SOMETHING", "E-MESHOPT-MODE"},
                          Case{"filter", "SOMETHING", "E-MESHOPT-MODE"},
                          Case{"filter", "QUATERNION", "E-MESHOPT-LAYOUT"},
                          Case{"filter", "OCTAHEDRAL", "E-MESHOPT-LAYOUT"},
                          Case{"filter", "COLOR", "E-MESHOPT-LAYOUT"},
                          Case{"byteStride", 10, "E-MESHOPT-LAYOUT"},
                          Case{"byteStride", 0, "E-MESHOPT-LAYOUT"},
                          Case{"byteStride", 260, "E-MESHOPT-LAYOUT"},
                          Case{"count", 2, "E-MESHOPT-LAYOUT"},
                          Case{"count", 1ULL << 52, "E-MESHOPT-LAYOUT"},
                          Case{"buffer", 2, "E-DOC-INDEX"},
                          Case{"byteOffset", 1ULL << 52, "E-BUF-RANGE"},
                          Case{"byteLength", 100000, "E-BUF-RANGE"},
                          Case{"byteLength", 5, "E-MESHOPT-DATA"}}) {
        json tree = compressed_triangle(name);
        tree["bufferViews"][0]["extensions"][name][c.key] = c.value;
        const Loaded loaded = load_tree(tree);
        EXPECT_EQ(loaded.id(), c.id) << c.key << ' ' << c.value;
        EXPECT_NE(loaded.text().find("#/bufferViews/0"), std::string::npos) << loaded.text();
    }
    json tree = compressed_triangle(name);
    tree["bufferViews"][3]["extensions"][name]["filter"] = "EXPONENTIAL";
    EXPECT_EQ(load_tree(tree).id(), "E-MESHOPT-MODE");
    tree["bufferViews"][0]["extensions"][name].erase("count");
    EXPECT_EQ(load_tree(tree).id(), "E-DOC-MISSING");
}

}  // namespace
}  // namespace obscura::gltf
