// tests/gltf/asset_files_test.cpp - the files that one glTF asset consists of.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/asset_files.h"

#include "gltf/images.h"
#include "gltf/load.h"

#include <gtest/gtest.h>

#include <gmock/gmock.h>

namespace obscura::gltf {
namespace {

using namespace test;
using testing::ElementsAre;

TEST(AssetFiles, EveryNamedFileCountsOnce) {
    AssetBuilder builder = triangle_builder();
    json tree = builder.finished();
    tree["buffers"][1] = {{"uri", "more.bin"}, {"byteLength", 4}};
    tree["images"] = {{{"uri", "sub/my%20picture.png"}},
                      {{"uri", png_uri(1, 1)}},
                      {{"uri", "sub/my%20picture.png"}},
                      {{"uri", "../outside.png"}}};
    tree["extensions"]["EXT_lights_ies"]["lights"] = {{{"uri", "lamp.ies"}}};
    const TempFolder folder;
    const auto file = folder.write("scene.gltf", tree.dump());
    EXPECT_THAT(
        files_of_asset(file),
        ElementsAre(file, folder / "more.bin", folder / "sub/my picture.png", folder / "lamp.ies"));
}

TEST(AssetFiles, WhatCannotBeReadIsAFileAlone) {
    const TempFolder folder;
    const auto broken = folder.write("broken.gltf", "{");
    EXPECT_THAT(files_of_asset(broken), ElementsAre(broken));
    EXPECT_THAT(files_of_asset(folder / "absent.glb"), ElementsAre(folder / "absent.glb"));
}

TEST(AssetFiles, OfAnOpenAssetAreTheSame) {
    for (const char* name : {"cornell/cornell.gltf", "alpha_test/alpha_test.gltf"}) {
        const std::filesystem::path file = OBSCURA_SOURCE_DIR "/assets/" + std::string(name);
        Log log;
        const Result<PosedAsset> asset = PosedAsset::open(file, {}, false, log);
        ASSERT_TRUE(asset) << name;
        EXPECT_EQ(asset->files(), files_of_asset(file));
    }
}

}  // namespace
}  // namespace obscura::gltf
