// tests/gltf/load_test.cpp - whole files: the chosen scene, messages, files that cannot be opened.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/load.h"

#include "gltf/gltf_files.h"

#include <gtest/gtest.h>

#include <sys/stat.h>

namespace obscura::gltf {
namespace {

using namespace test;

TEST(Load, FilesThatAreNotThere) {  // A2, A3
    const TempFolder folder;
    ASSERT_EQ(::mkfifo((folder / "fifo.glb").c_str(), 0600), 0);
    for (const std::filesystem::path& path : {folder / "absent.glb",
                                              folder.path(),
                                              folder / "fifo.glb",
                                              std::filesystem::path("/dev/zero"),
                                              folder / "a/b.glb"}) {
        const Loaded loaded = load_file(path);
        EXPECT_EQ(loaded.code(), 66) << path;
        EXPECT_EQ(loaded.id(), "E-SCENE-MISSING") << path;
        EXPECT_EQ(loaded.scene.error().where, path.string());
    }
}

TEST(Load, NamesOfEveryKindWork) {  // H7
    for (const char* name : {"with space.gltf",
                             "%s%n.gltf",
                             "-o.gltf",
                             "new\nline.gltf",
                             "not\xFFutf8.gltf",
                             "h\xC3\xA9.gltf"}) {
        EXPECT_TRUE(load_bytes(triangle_asset().dump(), name).scene) << name;
    }
}

/// Three scenes: the first shows node 0, the second two copies of it, the third nothing.
json three_scenes() {
    AssetBuilder builder = triangle_builder();
    builder.tree["nodes"].push_back({{"mesh", 0}, {"name", "Copy"}});
    builder.tree["nodes"].push_back({{"mesh", 0}});
    builder.tree["scenes"] = {
        {{"nodes", {0}}, {"name", "One"}}, {{"nodes", {1, 2}}, {"name", "Two"}}, json::object()};
    return builder.finished();
}

LoadOptions by_number(int scene) {
    LoadOptions options;
    options.scene = scene;
    return options;
}

LoadOptions by_name(const std::string& name) {
    LoadOptions options;
    options.scene_name = name;
    return options;
}

TEST(Load, ChoosesTheScene) {
    json tree = three_scenes();
    EXPECT_EQ(load_tree(tree).scene->info.scene, 0);
    tree["scene"] = 1;
    EXPECT_EQ(load_tree(tree).scene->info.scene, 1);
    EXPECT_EQ(load_tree(tree).scene->info.triangles_in_world, 2U);
    EXPECT_EQ(load_tree(tree, by_number(0)).scene->info.triangles_in_world, 1U);
    EXPECT_EQ(load_tree(tree, by_name("One")).scene->info.scene, 0);
    EXPECT_EQ(load_tree(tree, by_name("scene 2")).scene->info.scene, 2);
}

TEST(Load, UnknownScenesAreUsageErrorsThatListTheOthers) {
    for (const LoadOptions& options : {by_number(3), by_name("Three")}) {
        const Loaded loaded = load_tree(three_scenes(), options);
        EXPECT_EQ(loaded.code(), 64);
        EXPECT_EQ(loaded.id(), "E-SCENE-UNKNOWN");
        EXPECT_NE(loaded.text().find("0 \"One\", 1 \"Two\", 2 \"scene 2\""), std::string::npos)
            << loaded.text();
    }
}

TEST(Load, EmptyScenesWarn) {  // B12
    const Loaded empty = load_tree(three_scenes(), by_number(2));
    ASSERT_TRUE(empty.scene) << empty.text();
    EXPECT_TRUE(empty.warns("no triangles"));
    EXPECT_TRUE(empty.scene->bounds.empty());
    EXPECT_EQ(empty.scene->materials.size(), 1U);
    const Loaded nothing = load_tree({{"asset", {{"version", "2.0"}}}});
    ASSERT_TRUE(nothing.scene) << nothing.text();
    EXPECT_TRUE(nothing.warns("no scene"));
}

TEST(Load, WithoutScenesAllRootsAreDrawn) {
    json tree = three_scenes();
    tree.erase("scenes");
    const Loaded loaded = load_tree(tree);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded.scene->info.triangles_in_world, 3U);
    EXPECT_EQ(load_tree(tree, by_number(0)).code(), 64);
}

TEST(Load, TellsWhatTheFileHolds) {
    json tree = three_scenes();
    tree["asset"]["generator"] = "a test";
    tree["asset"]["copyright"] = "nobody";
    tree["animations"] = {
        {{"channels", json::array()}, {"samplers", json::array()}, {"name", "Walk"}}};
    const TempFolder folder;
    const Loaded loaded = load_file(folder.write("a file.gltf", tree.dump()));
    ASSERT_TRUE(loaded.scene) << loaded.text();
    const AssetInfo& info = loaded.scene->info;
    EXPECT_EQ(info.file_name, "a file.gltf");
    EXPECT_EQ(info.version, "2.0");
    EXPECT_EQ(info.generator, "a test");
    EXPECT_EQ(info.copyright, "nobody");
    EXPECT_EQ(info.scenes, (std::vector<std::string>{"One", "Two", "scene 2"}));
    EXPECT_EQ(info.node_names, (std::vector<std::string>{"node 0", "Copy", "node 2"}));
    ASSERT_EQ(info.animations.size(), 1U);
    EXPECT_EQ(info.animations[0].name, "Walk");
    EXPECT_EQ(info.animations[0].channels, 0U);
    EXPECT_EQ(info.animations[0].end_s, 0);
    EXPECT_GT(info.parse_seconds, 0);
}

TEST(Load, ControlCharactersInNamesAreEscapedInWarnings) {  // B13
    json tree = triangle_asset();
    tree["materials"][0] = {{"name", "red\x1B[31m\n"},
                            {"extensions", {{"VENDOR_materials_glow", json::object()}}}};
    const Loaded loaded = load_tree(tree);
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_TRUE(loaded.warns("red\\x1b[31m\\x0a")) << loaded.warnings;
}

/// Random damage to a whole file: any answer but a crash, and always one.
TEST(Load, DamagedFilesNeverCrash) {
    const std::string whole = triangle_builder().glb();
    const TempFolder folder;
    uint32_t state = 1;
    const auto next = [&] { return state = state * 1664525U + 1013904223U, state >> 8; };
    for (int i = 0; i < 1500; ++i) {
        std::string bytes = whole;
        for (uint32_t n = next() % 4 + 1; n > 0; --n) {
            bytes[next() % bytes.size()] = static_cast<char>(next());
        }
        const Loaded loaded = load_file(folder.write("damaged.glb", bytes));
        EXPECT_EQ(loaded.scene.has_value(), loaded.id().empty());
        EXPECT_NE(loaded.code(), static_cast<int>(ExitCode::internal)) << loaded.text();
    }
}

}  // namespace
}  // namespace obscura::gltf
