// tests/gltf/variants_test.cpp - KHR_materials_variants: only the chosen variant applies.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/variants.h"

#include "gltf/gltf_files.h"

#include <gtest/gtest.h>

namespace obscura::gltf {
namespace {

using namespace test;

constexpr const char* name = "KHR_materials_variants";

/// Two primitives: the first is Red in "day" and "dusk", Blue in "night"; the second stays Grey.
json product() {
    json tree = triangle_asset();
    for (const char* material : {"Grey", "Red", "Blue"})
        tree["materials"].push_back({{"name", material}});
    for (const char* variant : {"day", "dusk", "night"})
        tree["extensions"][name]["variants"].push_back({{"name", variant}});
    json& primitives = tree["meshes"][0]["primitives"];
    primitives[0]["material"] = 0;
    primitives.push_back(primitives[0]);
    primitives[0]["extensions"][name]["mappings"] = {{{"material", 1}, {"variants", {0, 1}}},
                                                     {{"material", 2}, {"variants", {2}}}};
    return tree;
}

std::vector<std::string> materials_in(const std::string& variant) {
    LoadOptions options;
    options.variant = variant;
    const Loaded loaded = load_tree(product(), options);
    EXPECT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.warnings, "");
    EXPECT_EQ(loaded.scene->info.variants, (std::vector<std::string>{"day", "dusk", "night"}));
    EXPECT_EQ(loaded.scene->info.variant, variant);
    std::vector<std::string> out;
    for (const Primitive& primitive : loaded.scene->primitives)
        out.push_back(loaded.scene->material_names[static_cast<size_t>(primitive.material)]);
    return out;
}

TEST(Variants, GiveEachPrimitiveItsMaterial) {
    EXPECT_EQ(materials_in(""), (std::vector<std::string>{"Grey", "Grey"}));
    EXPECT_EQ(materials_in("day"), (std::vector<std::string>{"Red", "Grey"}));
    EXPECT_EQ(materials_in("dusk"), (std::vector<std::string>{"Red", "Grey"}));
    EXPECT_EQ(materials_in("night"), (std::vector<std::string>{"Blue", "Grey"}));
}

TEST(Variants, EqualOnesAndThoseWithoutANameAreToldApart) {
    json tree = product();
    json& variants = tree["extensions"]["KHR_materials_variants"]["variants"];
    variants[0]["name"] = variants[1]["name"] = "night";
    variants[2]["name"] = "";
    LoadOptions options;
    options.variant = "variant";
    const Loaded loaded = load_tree(tree, options);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.scene->info.variants,
              (std::vector<std::string>{"night", "night-2", "variant"}));
    EXPECT_EQ(
        loaded.scene->material_names[static_cast<size_t>(loaded.scene->primitives[0].material)],
        "Blue");
    EXPECT_NE(loaded.warnings.find("/variants/1"), std::string::npos) << loaded.warnings;
    EXPECT_NE(loaded.warnings.find("has no name"), std::string::npos) << loaded.warnings;
    variants[0]["name"] = "";
    variants[1]["name"] = "variant";
    variants[2]["name"] = "";
    options.variant.clear();
    EXPECT_EQ(load_tree(tree, options).scene->info.variants,
              (std::vector<std::string>{"variant-2", "variant", "variant-3"}));
    variants[0].erase("name");
    const Loaded nameless = load_tree(tree, options);
    EXPECT_EQ(nameless.id(), "E-DOC-MISSING");
    EXPECT_EQ(nameless.warnings, "");
}

TEST(Variants, UnknownOnesAreErrorsThatListTheNames) {
    LoadOptions options;
    options.variant = "noon";
    const Loaded loaded = load_tree(product(), options);
    EXPECT_EQ(loaded.code(), 64);
    EXPECT_EQ(loaded.id(), "E-VARIANT-UNKNOWN");
    EXPECT_NE(loaded.text().find("\"day\", \"dusk\", \"night\""), std::string::npos);
    EXPECT_NE(load_bytes(triangle_asset().dump(), "a.gltf", options).text().find("none"),
              std::string::npos);
}

TEST(Variants, NumbersOutOfRangeAreErrors) {
    json tree = product();
    json& mapping = tree["meshes"][0]["primitives"][0]["extensions"][name]["mappings"][0];
    mapping["variants"] = {3};
    EXPECT_EQ(load_tree(tree).id(), "E-DOC-INDEX");
    mapping["variants"] = {0};
    mapping["material"] = 3;
    EXPECT_EQ(load_tree(tree).id(), "E-DOC-INDEX");
    mapping.erase("material");
    EXPECT_EQ(load_tree(tree).id(), "E-DOC-MISSING");
}

}  // namespace
}  // namespace obscura::gltf
