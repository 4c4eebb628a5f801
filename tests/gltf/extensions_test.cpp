// tests/gltf/extensions_test.cpp - warnings and errors about unsupported extensions.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/extensions.h"

#include "gltf/gltf_files.h"
#include "gltf/parse/material_factors.h"
#include "gltf/parse/tree_rules.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace obscura::gltf {
namespace {

using namespace test;

size_t count_of(const std::string& text, const std::string& part) {
    size_t out = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++out;
    return out;
}

TEST(Extensions, RequiredUnknownOnesAreAllListed) {  // F1
    json tree = triangle_asset();
    tree["extensionsUsed"] = {"A_one", "KHR_materials_unlit", "B_two"};
    tree["extensionsRequired"] = {"A_one", "KHR_materials_unlit", "B_two"};
    const Loaded loaded = load_tree(tree);
    EXPECT_EQ(loaded.code(), 69);
    EXPECT_EQ(loaded.id(), "E-EXT-REQUIRED");
    EXPECT_NE(loaded.text().find("A_one, B_two"), std::string::npos) << loaded.text();
    EXPECT_EQ(loaded.text().find("KHR_materials_unlit"), std::string::npos);
}

/// Three tables name what is read of materials: what reads it, what the checks leave in the tree,
/// and what is said to be supported.
TEST(Extensions, ThoseOfMaterialsAreInAllTables) {
    const auto left = material_rules.extensions;
    constexpr std::string_view folder = "extensions/";
    for (const MaterialEntry& entry : material_entries) {
        const std::string_view place = entry.object.place;
        if (!place.starts_with(folder)) continue;
        const std::string_view name = place.substr(folder.size());
        EXPECT_NE(std::find(left.begin(), left.end(), name), left.end()) << name;
    }
    for (const std::string_view name : left) {
        const ExtensionEntry* entry = find_extension(name);
        ASSERT_NE(entry, nullptr) << name;
        EXPECT_TRUE(entry->supported) << name;
    }
}

/// A required extension may change what the rest means: it is looked at first.
TEST(Extensions, RequiredOnesAreCheckedBeforeTheRest) {
    json tree = triangle_asset();
    tree["extensionsRequired"] = {"A_one"};
    tree["accessors"][0]["componentType"] = 9999;
    EXPECT_EQ(load_tree(tree).id(), "E-EXT-REQUIRED");
}

TEST(Extensions, OptionalOnesWarnOnceWithTheirMaterials) {  // F2
    json tree = triangle_asset();
    for (const char* name : {"Glass", "Plain", "Wine"}) {
        json material = {{"name", name}};
        if (std::string(name) != "Plain") {
            material["extensions"]["VENDOR_materials_glow"] = json::object();
        }
        tree["materials"].push_back(material);
    }
    tree["extensionsUsed"] = {"VENDOR_materials_glow"};
    const Loaded loaded = load_tree(tree);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(count_of(loaded.warnings, "VENDOR_materials_glow"), 1U);
    EXPECT_TRUE(loaded.warns("materials: Glass, Wine\n")) << loaded.warnings;
    ASSERT_EQ(loaded.scene->info.extensions.size(), 1U);
    const ExtensionInfo& info = loaded.scene->info.extensions[0];
    EXPECT_EQ(info.name, "VENDOR_materials_glow");
    EXPECT_FALSE(info.supported);
    EXPECT_FALSE(info.required);
    EXPECT_EQ(info.materials, (std::vector<std::string>{"Glass", "Wine"}));
}

TEST(Extensions, UsesAreFoundWhereverTheyAre) {
    json tree = triangle_asset();
    tree["nodes"][0]["extensions"]["X_node"] = json::object();
    tree["meshes"][0]["name"] = "Hull";
    tree["meshes"][0]["primitives"][0]["extensions"]["X_mesh"] = json::object();
    tree["extensions"]["X_top"] = json::object();
    tree["materials"][0]["normalTexture"]["index"] = 0;
    tree["materials"][0]["normalTexture"]["extensions"]["X_slot"] = json::object();
    tree["materials"][0]["extras"]["extensions"]["X_extra"] = json::object();
    tree["textures"][0] = json::object();
    const Loaded loaded = load_tree(tree);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_TRUE(loaded.warns("X_node is not supported; used by node 0"));
    EXPECT_TRUE(loaded.warns("X_mesh is not supported; used by mesh Hull"));
    EXPECT_TRUE(loaded.warns("X_top is not supported\n"));
    EXPECT_TRUE(loaded.warns("X_slot is not supported; materials: material 0"));
    EXPECT_FALSE(loaded.warns("X_extra"));
}

TEST(Extensions, SupportedOnesAreSilent) {
    json tree = triangle_asset();
    size_t supported = 0;
    for (const ExtensionEntry& entry : extension_table()) {
        if (!entry.supported) continue;
        tree["extensionsRequired"].push_back(std::string(entry.name));
        ++supported;
    }
    const Loaded loaded = load_tree(tree);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.warnings, "");
    EXPECT_EQ(loaded.scene->info.extensions.size(), supported);
    for (const ExtensionInfo& info : loaded.scene->info.extensions)
        EXPECT_TRUE(info.supported);
}

TEST(Extensions, TheTableNamesEachOnce) {
    std::vector<std::string_view> names;
    for (const ExtensionEntry& entry : extension_table()) {
        names.push_back(entry.name);
        EXPECT_EQ(entry.supported, entry.without.empty()) << entry.name;
        EXPECT_TRUE(entry.verdict == Verdict::honoured || !entry.note.empty()) << entry.name;
    }
    std::sort(names.begin(), names.end());
    EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
}

}  // namespace
}  // namespace obscura::gltf
