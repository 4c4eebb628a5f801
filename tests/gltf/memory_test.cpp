// tests/gltf/memory_test.cpp - an asset's bytes are charged before there is memory for them.
// SPDX-License-Identifier: Apache-2.0
#include "base/memory_budget.h"
#include "gltf/gltf_files.h"
#include "gltf/images.h"

#include <gtest/gtest.h>

#include <gmock/gmock.h>

namespace obscura::gltf {
namespace {

using namespace test;
using testing::HasSubstr;

/// A budget with so much room beside the program.
struct Room {
    explicit Room(uint64_t bytes) { set_memory_limit(program_memory_bytes + bytes, "a test"); }
    ~Room() { remove_memory_limit(); }
    Room(const Room&) = delete;
    Room& operator=(const Room&) = delete;
};

json textured(int side) {
    json tree = triangle_asset();
    tree["materials"][0] = {{"emissiveTexture", {{"index", 0}}}};
    tree["meshes"][0]["primitives"][0]["material"] = 0;
    tree["textures"][0]["source"] = 0;
    tree["images"][0] = {{"uri", png_uri(side, side)}, {"name", "Label"}};
    return tree;
}

TEST(AssetMemory, TexturesAreMeasuredBeforeTheyAreDecoded) {
    const json tree = textured(512);  // 1.4 MB with its mip chain
    {
        const Room room(uint64_t{40} << 20);
        const Loaded loaded = load_tree(tree);
        EXPECT_TRUE(loaded.scene) << loaded.text();
    }
    const Room room(1U << 20);
    const Loaded loaded = load_tree(tree);
    ASSERT_FALSE(loaded.scene);
    const Error& error = loaded.scene.error();
    EXPECT_EQ(error.code, ExitCode::out_of_memory);
    EXPECT_EQ(error.id, "E-MEM");
    EXPECT_THAT(error.message, HasSubstr("textures would take 1 MiB"));
}

TEST(AssetMemory, AnAssetGivesBackWhatItTook) {
    const Room room(uint64_t{40} << 20);
    const json tree = textured(512);
    for (int i = 0; i < 40; ++i)
        ASSERT_TRUE(load_tree(tree).scene);
    EXPECT_TRUE(charge_memory(MemoryUse::buffers, "all", uint64_t{40} << 20));
}

TEST(AssetMemory, DataUrisAreCharged) {
    json tree = triangle_asset();
    tree["buffers"][0]["uri"] =
        "data:application/octet-stream;base64," + std::string(4U << 20, 'A');
    tree["buffers"][0]["byteLength"] = 3U << 20;
    const Room room(uint64_t{15} << 20);  // text and tree take twelve
    const Loaded loaded = load_tree(tree);
    ASSERT_FALSE(loaded.scene);
    EXPECT_EQ(loaded.scene.error().id, "E-MEM");
}

TEST(AssetMemory, TheTextIsChargedBeforeItIsRead) {
    const Room room(1000);
    const Loaded loaded = load_tree(textured(16));
    ASSERT_FALSE(loaded.scene);
    EXPECT_EQ(loaded.scene.error().id, "E-MEM");
    EXPECT_THAT(loaded.scene.error().message, HasSubstr("the scene's text would take"));
}

}  // namespace
}  // namespace obscura::gltf
