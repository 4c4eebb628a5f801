// tests/gltf/report_test.cpp - the report of an asset's features, and the table in the docs.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/report.h"

#include "gltf/gltf_files.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

namespace obscura::gltf {
namespace {

using namespace test;

std::vector<std::string> lines_of_report(const json& tree) {
    const Loaded loaded = load_tree(tree);
    EXPECT_TRUE(loaded.scene) << loaded.text();
    std::vector<std::string> out;
    if (!loaded.scene) return out;
    for (const ReportEntry& entry : loaded.scene->info.report) {
        out.push_back(entry.place + ": " + entry.feature + " " +
                      std::string(verdict_name(entry.verdict)) +
                      (entry.note.empty() ? "" : " (" + entry.note + ")"));
    }
    return out;
}

TEST(Report, NamesEveryPartWithWhatItAsksFor) {
    json tree = triangle_asset();
    tree["extensionsUsed"] = {"KHR_mesh_quantization", "X_unknown"};
    tree["extensions"]["KHR_interactivity"] = json::object();
    tree["nodes"][0]["name"] = "Lid";
    tree["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = true;
    tree["materials"][0]["name"] = "Glass";
    tree["materials"][0]["alphaMode"] = "MASK";
    tree["materials"][0]["extensions"]["KHR_materials_unlit"] = json::object();
    tree["materials"][0]["occlusionTexture"]["index"] = 0;
    tree["textures"][0] = json::object();
    tree["animations"][0] = {{"channels", json::array()}, {"samplers", json::array()}};
    EXPECT_EQ(lines_of_report(tree),
              (std::vector<std::string>{
                  "asset: KHR_interactivity ignored (a still picture has none)",
                  "asset: KHR_mesh_quantization honoured",
                  "asset: X_unknown ignored (it is not known)",
                  "node 0 Lid: KHR_node_visibility honoured",
                  "material 0 Glass: occlusionTexture ignored (what it guesses is traced: light "
                  "that nearby geometry blocks; --occlusion ambient applies it)",
                  "material 0 Glass: alphaMode MASK honoured",
                  "material 0 Glass: KHR_materials_unlit honoured",
                  "animation 0: animation honoured (played by --time and --frames, chosen by "
                  "--animation)"}));
}

TEST(Report, ExtensionsInsidePartsAreFound) {
    json tree = triangle_asset();
    tree["materials"][0]["normalTexture"]["index"] = 0;
    tree["materials"][0]["normalTexture"]["extensions"]["KHR_texture_transform"] = json::object();
    tree["textures"][0] = json::object();
    EXPECT_EQ(lines_of_report(tree),
              (std::vector<std::string>{"material 0: normalTexture honoured",
                                        "material 0: KHR_texture_transform honoured (on every "
                                        "texture)"}));
    EXPECT_TRUE(lines_of_report(triangle_asset()).empty());
}

/// Each entry's function must find its feature in a part that has all features, and must not find
/// it in an empty part, unless the part itself is the feature.
TEST(Report, EveryFeatureCanBeFound) {
    const json primitive = {{"mode", 0},
                            {"attributes", {{"POSITION", 0}, {"COLOR_0", 0}}},
                            {"targets", json::array({json::object()})}};
    json line = primitive;
    line["mode"] = 3;
    const json part = {
        {"skin", 0},
        {"primitives", {primitive, line}},
        {"pbrMetallicRoughness",
         {{"baseColorTexture", json::object()}, {"metallicRoughnessTexture", json::object()}}},
        {"normalTexture", json::object()},
        {"emissiveTexture", json::object()},
        {"occlusionTexture", json::object()},
        {"sparse", json::object()}};
    for (const FeatureEntry& entry : feature_table()) {
        json with = part;
        if (entry.name.rfind("alphaMode ", 0) == 0) with["alphaMode"] = entry.name.substr(10);
        EXPECT_TRUE(entry.is_used(with)) << entry.name;
        const bool always = entry.name == "camera" || entry.name == "animation";
        EXPECT_EQ(entry.is_used(json::object()), always) << entry.name;
        EXPECT_TRUE(entry.verdict != Verdict::ignored || !entry.note.empty()) << entry.name;
    }
}

/// The line of docs/gltf.md for an entry.
std::string documented(const ExtensionEntry& entry) {
    const Verdict verdict = entry.supported ? entry.verdict : Verdict::ignored;
    const std::string note(entry.supported ? entry.note : entry.without);
    return "| " + std::string(entry.name) + " | " + std::string(verdict_name(verdict)) + " | " +
           note + (note.empty() ? "|" : " |");
}

TEST(Report, TheDocumentationHoldsTheTable) {
    std::ifstream file(OBSCURA_SOURCE_DIR "/docs/gltf.md");
    ASSERT_TRUE(file);
    std::set<std::string> lines;
    for (std::string line; std::getline(file, line);) {
        const bool entry = line.find(" | honoured |") != std::string::npos ||
                           line.find(" | approximated |") != std::string::npos ||
                           line.find(" | ignored |") != std::string::npos;
        if (entry) lines.insert(line);
    }
    for (const ExtensionEntry& entry : extension_table())
        EXPECT_EQ(lines.erase(documented(entry)), 1U)
            << "docs/gltf.md lacks: " << documented(entry);
    for (const std::string& line : lines)
        ADD_FAILURE() << "docs/gltf.md says what the table does not: " << line;
}

}  // namespace
}  // namespace obscura::gltf
