// tests/gltf/report_test.cpp - the report tells what becomes of each part's wishes, and docs too.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/report.h"

#include "gltf/gltf_files.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

namespace obscura {
namespace {

using namespace testing_gltf;

std::vector<std::string> lines_of_report(const json& tree) {
    const Loaded loaded = load_tree(tree);
    EXPECT_TRUE(loaded.scene) << loaded.text();
    std::vector<std::string> out;
    if (!loaded.scene) return out;
    for (const ReportRow& row : loaded.scene->info.report) {
        out.push_back(row.place + ": " + row.feature + " " +
                      std::string(verdict_name(row.verdict)) +
                      (row.note.empty() ? "" : " (" + row.note + ")"));
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

/// Each row's own function must find its feature in a part that has all of them, and none in an
/// empty one, but for those that the part itself is.
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
    for (const FeatureRow& row : feature_table()) {
        json with = part;
        if (row.name.rfind("alphaMode ", 0) == 0) with["alphaMode"] = row.name.substr(10);
        EXPECT_TRUE(row.is_used(with)) << row.name;
        const bool always = row.name == "camera" || row.name == "animation";
        EXPECT_EQ(row.is_used(json::object()), always) << row.name;
        EXPECT_TRUE(row.verdict != Verdict::ignored || !row.note.empty()) << row.name;
    }
}

/// The line that docs/gltf.md must have for a row.
std::string documented(const ExtensionRow& row) {
    const Verdict verdict = row.supported ? row.verdict : Verdict::ignored;
    const std::string note(row.supported ? row.note : row.without);
    return "| " + std::string(row.name) + " | " + std::string(verdict_name(verdict)) + " | " +
           note + (note.empty() ? "|" : " |");
}

TEST(Report, TheDocumentationHoldsTheTable) {
    std::ifstream file(OBSCURA_SOURCE_DIR "/docs/gltf.md");
    ASSERT_TRUE(file);
    std::set<std::string> lines;
    for (std::string line; std::getline(file, line);) {
        const bool row = line.find(" | honoured |") != std::string::npos ||
                         line.find(" | approximated |") != std::string::npos ||
                         line.find(" | ignored |") != std::string::npos;
        if (row) lines.insert(line);
    }
    for (const ExtensionRow& row : extension_table())
        EXPECT_EQ(lines.erase(documented(row)), 1U) << "docs/gltf.md lacks: " << documented(row);
    for (const std::string& line : lines)
        ADD_FAILURE() << "docs/gltf.md says what the table does not: " << line;
}

}  // namespace
}  // namespace obscura
