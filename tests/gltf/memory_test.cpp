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

/// The messages with which an asset is refused in rooms that grow until it fits.
std::string refusals(const json& tree, uint64_t step) {
    std::string messages;
    for (uint64_t room = step; room < 100 * step; room += step) {
        const Room here(room);
        const Loaded loaded = load_tree(tree);
        if (loaded.scene) return messages;
        EXPECT_EQ(loaded.scene.error().code, ExitCode::out_of_memory);
        EXPECT_EQ(loaded.scene.error().id, "E-MEM");
        messages += loaded.scene.error().message + "\n";
    }
    ADD_FAILURE() << "never fits";
    return messages;
}

TEST(AssetMemory, TexturesAreMeasuredBeforeTheyAreDecoded) {
    EXPECT_THAT(refusals(textured(32), 1000), HasSubstr("textures would take"));
}

TEST(AssetMemory, AnAssetGivesBackWhatItTook) {
    constexpr uint64_t bytes = 2U << 20;
    const Room room(bytes);
    const json tree = textured(32);
    for (int i = 0; i < 40; ++i)
        ASSERT_TRUE(load_tree(tree).scene);
    EXPECT_TRUE(charge_memory(MemoryUse::buffers, "all", bytes));
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
