// tests/bench/asset_files_test.cpp - where the bench finds scenes when none is given.
// SPDX-License-Identifier: Apache-2.0
#include "bench/asset_files.h"

#include <gtest/gtest.h>

#include "support/temp_folder.h"
#include <filesystem>

namespace obscura::bench {
namespace {

namespace fs = std::filesystem;

TEST(AssetFiles, AreFoundBesideTheProgramAndWhereTheyAreInstalled) {
    const TempFolder folder;
    const fs::path bin = folder / "prefix/bin";
    fs::create_directories(bin);
    fs::create_directories(folder / "prefix/share/obscura/assets/room");
    EXPECT_FALSE(find_assets_folder(bin) &&
                 find_assets_folder(bin)->string().starts_with(folder.path().string()));
    folder.write("prefix/share/obscura/assets/room/room.gltf", "{}");
    EXPECT_EQ(find_assets_folder(bin).value(), folder / "prefix/share/obscura/assets");
    fs::create_directories(folder / "prefix/assets");
    folder.write("prefix/assets/box.glb", "");
    EXPECT_EQ(find_assets_folder(bin).value(), folder / "prefix/assets");
}

}  // namespace
}  // namespace obscura::bench
