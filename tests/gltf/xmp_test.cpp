// tests/gltf/xmp_test.cpp - the packet that the asset names, and no other.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/xmp.h"

#include "gltf/gltf_files.h"

#include <gtest/gtest.h>

namespace obscura::gltf {
namespace {

using namespace test;

TEST(Xmp, TheAssetsPacketIsKept) {
    json tree = triangle_asset();
    const json packet = {{"@context", {{"dc", "http://purl.org/dc/elements/1.1/"}}},
                         {"dc:creator", "Ada \u00e9\x7F"}};
    tree["extensions"]["KHR_xmp_json_ld"]["packets"] = {json::object(), packet};
    EXPECT_EQ(load_tree(tree).scene->info.xmp, "") << "nobody names it";
    tree["asset"]["extensions"]["KHR_xmp_json_ld"]["packet"] = 1;
    const Loaded loaded = load_tree(tree);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(json::parse(loaded.scene->info.xmp), packet);
    EXPECT_EQ(loaded.scene->info.xmp.find('\x7F'), std::string::npos) << "headers escape it";
    EXPECT_EQ(loaded.warnings, "");
    tree["asset"]["extensions"]["KHR_xmp_json_ld"]["packet"] = 2;
    EXPECT_EQ(load_tree(tree).id(), "E-DOC-INDEX");
}

TEST(Xmp, TheOlderExtensionsVocabularyJoinsItsPacket) {
    json tree = triangle_asset();
    tree["extensions"]["KHR_xmp"] = {{"@context", {{"dc", "x"}}},
                                     {"packets", {{{"dc:title", "Box"}}}}};
    tree["asset"]["extensions"]["KHR_xmp"]["packet"] = 0;
    const json expected = {{"@context", {{"dc", "x"}}}, {"dc:title", "Box"}};
    EXPECT_EQ(json::parse(load_tree(tree).scene->info.xmp), expected);
}

TEST(Xmp, LongPacketsAreLeftOut) {
    json tree = triangle_asset();
    const std::string text(longest_xmp, 'x');
    tree["extensions"]["KHR_xmp_json_ld"]["packets"][0]["dc:title"] = text;
    tree["asset"]["extensions"]["KHR_xmp_json_ld"]["packet"] = 0;
    const Loaded loaded = load_tree(tree);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.scene->info.xmp, "");
    EXPECT_TRUE(loaded.warns("XMP"));
}

}  // namespace
}  // namespace obscura::gltf
