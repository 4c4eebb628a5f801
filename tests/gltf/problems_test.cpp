// tests/gltf/problems_test.cpp - faulty assets are refused whole, or loaded with warnings.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/problems.h"

#include "base/parallel.h"
#include "gltf/faulty_files.h"

#include <gtest/gtest.h>

#include <cmath>

namespace obscura::gltf {
namespace {

using namespace test;

/// Ids and places of all problems, in order.
std::vector<std::string> listed(const Loaded& loaded) {
    std::vector<std::string> out;
    if (loaded.scene) return out;
    const auto add = [&](const Error& error) {
        out.push_back(error.id + " " + error.where.substr(error.where.find('#') + 1));
    };
    add(loaded.scene.error());
    for (const Error& error : loaded.scene.error().also)
        add(error);
    return out;
}

TEST(Problems, StrictLoadingListsAllOfThem) {
    AssetBuilder builder = textured_builder();
    json& tree = builder.tree;
    tree["images"] = json::parse(R"([{"uri": "a.png"}, {"uri": "../b.png"}])");
    set_first_float(builder, 0, NAN);
    const int good =
        builder.add_accessor("VEC3", 5126, std::vector<float>{0, 0, 0, 2, 0, 0, 0, 1, 0});
    json other = tree["meshes"][0]["primitives"][0];
    other["attributes"] = {{"POSITION", good}, {"NORMAL", 3}};
    tree["meshes"][0]["primitives"].push_back(other);
    other["attributes"] = {{"POSITION", good}, {"TEXCOORD_0", 2}};
    tree["meshes"][0]["primitives"].push_back(other);
    EXPECT_EQ(listed(load_tree(builder.finished())),
              (std::vector<std::string>{"E-MESH-POSITION /meshes/0/primitives/0",
                                        "E-MESH-ATTRIBUTE /meshes/0/primitives/1",
                                        "E-RES-MISSING /images/0/uri",
                                        "E-URI-REFUSED /images/1/uri"}));
    const LenientlyLoaded lenient = load_leniently(builder.finished());
    EXPECT_EQ(listed(lenient), (std::vector<std::string>{"E-URI-REFUSED /images/1/uri"}));
}

TEST(Problems, ImagesOfFaultyPrimitivesAreListedToo) {
    AssetBuilder builder = textured_builder();
    builder.tree["images"][0]["uri"] = "a.png";
    set_first_float(builder, 0, NAN);
    EXPECT_EQ(listed(load_tree(builder.finished())),
              (std::vector<std::string>{"E-MESH-POSITION /meshes/0/primitives/0",
                                        "E-RES-MISSING /images/0/uri"}));
    const LenientlyLoaded lenient = load_leniently(builder.finished());
    ASSERT_TRUE(lenient.scene) << lenient.text();
    EXPECT_EQ(lenient.lost.textures, 0U);
}

TEST(Problems, MissingBuffersAreAllListed) {
    json tree = triangle_asset();
    tree["buffers"][0]["uri"] = "a.bin";
    tree["buffers"].push_back({{"byteLength", 4}, {"uri", "b.bin"}});
    tree["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 4}});
    EXPECT_EQ(
        listed(load_tree(tree)),
        (std::vector<std::string>{"E-RES-MISSING /buffers/0/uri", "E-RES-MISSING /buffers/1/uri"}));
}

/// 130 materials, each with an image that is missing, on as many primitives.
json many_missing() {
    AssetBuilder builder = textured_builder();
    json& tree = builder.tree;
    const json primitive = tree["meshes"][0]["primitives"][0];
    tree["meshes"][0]["primitives"] = json::array();
    tree["images"] = json::array();
    tree["textures"] = json::array();
    for (int i = 0; i < 130; ++i) {
        tree["images"].push_back({{"uri", std::to_string(i) + ".png"}});
        tree["textures"].push_back({{"source", i}});
        tree["materials"][static_cast<size_t>(i)]["pbrMetallicRoughness"]["baseColorTexture"] = {
            {"index", i}};
        tree["meshes"][0]["primitives"].push_back(primitive);
        tree["meshes"][0]["primitives"].back()["material"] = i;
    }
    return builder.finished();
}

TEST(Problems, TheirOrderDoesNotDependOnThreads) {
    const json tree = many_missing();
    std::vector<std::vector<std::string>> lists;
    for (const int threads : {1, 2, 7}) {
        const ThreadLimit limit(threads);
        lists.push_back(listed(load_tree(tree)));
    }
    EXPECT_EQ(lists[0], lists[1]);
    EXPECT_EQ(lists[0], lists[2]);
    ASSERT_EQ(lists[0].size(), 101U);
    EXPECT_EQ(lists[0][99], "E-RES-MISSING /images/99/uri");
}

TEST(Problems, BeyondAHundredTheyAreCounted) {
    const Loaded strict = load_tree(many_missing());
    ASSERT_FALSE(strict.scene);
    EXPECT_EQ(strict.scene.error().also.back().message, "30 more problems are not listed");
    const LenientlyLoaded lenient = load_leniently(many_missing());
    ASSERT_TRUE(lenient.scene) << lenient.text();
    EXPECT_EQ(lenient.lost.textures, 130U);
    EXPECT_EQ(std::count(lenient.warnings.begin(), lenient.warnings.end(), '\n'), 101);
    EXPECT_TRUE(lenient.warns("30 more problems are not listed"));
}

TEST(Problems, ABrokenImageIsMagentaAsColorAndAbsentAsData) {
    const std::string png = png_bytes(4, 4);
    for (const std::string& uri :
         {std::string("absent.png"),
          "data:image/png;base64," + base64(png.substr(0, png.size() / 2))}) {
        AssetBuilder builder = textured_builder();
        builder.tree["images"][0]["uri"] = uri;
        builder.tree["textures"][1]["source"] = 0;
        const LenientlyLoaded loaded = load_leniently(builder.finished());
        ASSERT_TRUE(loaded.scene) << loaded.text();
        const Material& material = loaded.scene->materials[1];
        EXPECT_EQ(material.metallic_roughness_texture.texture, -1);
        ASSERT_GE(material.base_color_texture.texture, 0);
        const auto texture = static_cast<size_t>(material.base_color_texture.texture);
        const TextureRecord& record = loaded.scene->textures.records[texture];
        for (int level = 0; level < record.levels; ++level) {
            const auto at = static_cast<size_t>(record.level_offset[level]);
            EXPECT_EQ(loaded.scene->textures.texels[at], 0xFFFF00FFU);
        }
        EXPECT_EQ(loaded.lost.textures, 1U);
    }
}

TEST(Problems, EveryPoseTellsWhatItLacks) {
    AssetBuilder builder = textured_builder();
    builder.tree["images"][0]["uri"] = "absent.png";
    const TempFolder folder;
    const auto file = folder.write("scene.gltf", builder.finished().dump());
    Log log(Verbosity::quiet);
    Result<PosedAsset> asset = PosedAsset::open(file, lenient_options(), true, log);
    ASSERT_TRUE(asset);
    for (const double time_s : {0.0, 1.0}) {
        Result<Scene> scene = asset->scene_at(time_s, false, log);
        ASSERT_TRUE(scene);
        EXPECT_EQ(asset->degraded().textures, 1U) << time_s;
        asset->take_back(std::move(*scene));
    }
}

TEST(Problems, TheSameOneCountsOnce) {
    Problems problems(true);
    const Error error{ExitCode::bad_data, "E-X", "a#/meshes/0", "bad"};
    problems.add(error, {Loss::primitive, "not drawn"});
    problems.add(error, {Loss::primitive, "not drawn"});
    Log log(Verbosity::quiet);
    const Result<Degraded> lost = problems.settle(nullptr, log);
    ASSERT_TRUE(lost);
    EXPECT_EQ(lost->primitives, 1U);
    EXPECT_EQ(log.warnings(), (std::vector<std::string>{"a#/meshes/0: bad; not drawn"}));
    EXPECT_EQ(problems.settle(nullptr, log)->primitives, 0U);
}

TEST(Problems, WhatEndsLoadingComesLast) {
    const Error data{ExitCode::bad_data, "E-X", "a#/meshes/0", "bad"};
    const Error end{ExitCode::out_of_memory, "E-MEMORY", "a", "full"};
    Log log(Verbosity::quiet);
    Problems strict;
    strict.add(data, {});
    const Result<Degraded> refused = strict.settle(&end, log);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().id, "E-X");
    ASSERT_EQ(refused.error().also.size(), 1U);
    EXPECT_EQ(refused.error().also[0].id, "E-MEMORY");
    Problems lenient(true);
    lenient.add(data, {});
    EXPECT_EQ(lenient.settle(&end, log).error().id, "E-MEMORY");
}

}  // namespace
}  // namespace obscura::gltf
