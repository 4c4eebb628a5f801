// tests/cli/layers_test.cpp - layers beside the beauty, in every layout that EXRs have.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include <nlohmann/json.hpp>
#include <set>

namespace obscura {
namespace {

using testing::Contains;
using testing::HasSubstr;

class Layers : public Cli {
protected:
    ProgramRun shot(std::vector<std::string> more) const {
        const std::vector<std::string> layers = {"--aov", "depth,crypto_object"};
        more.insert(more.end(), layers.begin(), layers.end());
        return render("quad.gltf", more);
    }

    /// The text attribute whose name ends so; "" if there is none.
    static std::string attribute(const ReadImage& image, const std::string& ending) {
        for (const OIIO::ParamValue& value : image.spec.extra_attribs)
            if (value.name().string().ends_with(ending)) return value.get_string();
        return "";
    }
};

TEST_F(Layers, OnePartHasAllOfThem) {
    expect_result(shot({"-o", "a.exr"}), 0, "OK");
    const auto image = read_image_file(folder_ / "a.exr");
    ASSERT_TRUE(image);
    EXPECT_EQ(image->channels.size(), 4U + 1 + 12);
    EXPECT_THAT(image->channels, Contains("depth.Z"));
    EXPECT_THAT(image->channels, Contains("crypto_object02.a"));
    EXPECT_EQ(attribute(*image, "/name"), "crypto_object");
    EXPECT_TRUE(nlohmann::json::parse(attribute(*image, "/manifest")).contains("/node 0"));
}

TEST_F(Layers, StandardOutputTakesThemInTheOneStream) {
    for (const char* layout : {"single", "multipart"}) {
        SCOPED_TRACE(layout);
        const ProgramRun run =
            shot({"-o", "-", "--format", "exr", "-o", "a.exr", "--exr-layout", layout});
        expect_result(run, 0, "OK");
        EXPECT_EQ(run.out, read_whole_file(folder_ / "a.exr"));
        EXPECT_THAT(run.out, HasSubstr("depth.Z")) << "or the part's channel";
    }
    expect_result(
        shot({"-o", "-", "--format", "exr", "--exr-layout", "separate"}), 64, "E-USAGE-CONFLICT");
}

TEST_F(Layers, SeparateFilesReplaceNothingElse) {
    expect_result(shot({"-o", "a.exr", "--exr-layout", "separate"}), 0, "OK");
    EXPECT_EQ(read_image_file(folder_ / "a.exr")->channels.size(), 4U);
    EXPECT_EQ(read_image_file(folder_ / "a.depth.exr")->channels.size(), 1U);
    EXPECT_EQ(read_image_file(folder_ / "a.crypto_object.exr")->channels.size(), 12U);
    expect_result(shot({"-o", "a.exr", "-o", "a.depth.exr", "--exr-layout", "separate"}),
                  64,
                  "E-USAGE-SAMEFILE");
    expect_result(shot({"-o", "a.png"}), 64, "E-USAGE-CONFLICT");
}

TEST_F(Layers, AManifestLiesBesideTheImageThatNamesIt) {
    expect_result(shot({"-o", "a.exr", "--crypto-manifest", "names.json"}), 0, "OK");
    const auto image = read_image_file(folder_ / "a.exr");
    ASSERT_TRUE(image);
    EXPECT_EQ(attribute(*image, "/manif_file"), "names.json");
    EXPECT_EQ(attribute(*image, "/manifest"), "");
    const auto manifest = nlohmann::json::parse(read_whole_file(folder_ / "names.json"));
    EXPECT_TRUE(manifest.contains("/node 0")) << manifest;
    std::filesystem::create_directory(folder_ / "other");
    for (const char* file : {"other/names.json", "b\\c.json"})
        expect_result(shot({"-o", "a.exr", "--crypto-manifest", file}), 64, "E-USAGE-CONFLICT");
    expect_result(shot({"-o", "a.exr", "--crypto-manifest", "a.exr"}), 64, "E-USAGE-SAMEFILE");
}

/// Whatever a node is called, the manifest in the header is JSON that has the name.
TEST_F(Layers, NamesWithControlCharactersAreInTheManifest) {
    SmallScene scene = lit_quad_scene();
    scene.nodes.replace(1, 0, R"("name": "a\u0007\u007f\u0085", )");
    folder_.write("odd.gltf", gltf_text(scene));
    expect_result(render("odd.gltf", {"-o", "a.exr", "--aov", "crypto_object"}), 0, "OK");
    const auto image = read_image_file(folder_ / "a.exr");
    ASSERT_TRUE(image);
    const std::string text = attribute(*image, "/manifest");
    const auto manifest = nlohmann::json::parse(text, nullptr, false);
    ASSERT_FALSE(manifest.is_discarded()) << text;
    EXPECT_TRUE(manifest.contains("/a\x07\x7F\xC2\x85")) << text;
}

/// Four quads that one node places beside each other, and a small one in front of their middle.
SmallScene tiles_scene() {
    SmallScene scene = lit_quad_scene();
    scene.nodes = R"({"name": "shelf", "children": [3]}, {"camera": 0, "translation": [0, 0, 3]},
{"extensions": {"KHR_lights_punctual": {"light": 0}}},
{"name": "tiles", "mesh": 0, "extensions":
{"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0}}}},
{"name": "lone", "mesh": 0, "translation": [0, 0, 1], "scale": [0.2, 0.2, 0.2]})";
    scene.roots = "0, 1, 2, 4";
    const std::string used = R"("extensionsUsed": [)";
    scene.more.insert(scene.more.find(used) + used.size(), R"("EXT_mesh_gpu_instancing", )");
    return scene;
}

TEST_F(Layers, InfoNamesTheNumbersOfNodesAndInstances) {
    folder_.write("tiles.gltf", gltf_text(tiles_scene()));
    expect_result(
        render("tiles.gltf", {"-o", "a.exr", "--aov", "id_node,instance,id_material"}), 0, "OK");
    const auto image = read_image_file(folder_ / "a.exr");
    ASSERT_TRUE(image);
    const auto number_at = [&](int x, int y, const std::string& layer) {
        const auto& names = image->channels;
        const auto channel = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
            return name.starts_with(layer + ".");
        });
        if (channel == names.end()) return -1;
        const auto at = static_cast<size_t>(y * image->width + x) * names.size();
        return static_cast<int>(image->pixels[at + static_cast<size_t>(channel - names.begin())]);
    };
    const auto info = nlohmann::json::parse(run({"info", "tiles.gltf", "--json"}).out);
    ASSERT_EQ(info.at("nodes").size(), 5U);
    const auto node_at = [&](int x, int y) {
        for (const auto& node : info.at("nodes"))
            if (node.at("id_node") == number_at(x, y, "id_node")) return node;
        return nlohmann::json();
    };
    std::set<int> tiles;
    for (const auto& [x, y] : {std::pair{6, 3}, {18, 3}, {6, 12}, {18, 12}}) {
        const nlohmann::json node = node_at(x, y);
        EXPECT_EQ(node.at("path"), "/shelf/tiles");
        EXPECT_EQ(node.at("mesh"), "Mesh");
        tiles.insert(number_at(x, y, "instance"));
    }
    EXPECT_EQ(tiles.size(), 4U);
    EXPECT_EQ(node_at(6, 3).at("instances"), nlohmann::json(tiles));
    const nlohmann::json lone = node_at(12, 8);
    EXPECT_EQ(lone.at("path"), "/lone");
    EXPECT_EQ(lone.at("instances"), nlohmann::json::array({number_at(12, 8, "instance")}));
    EXPECT_EQ(info.at("nodes").at(0).at("mesh"), "");
    EXPECT_EQ(info.at("nodes").at(0).at("instances"), nlohmann::json::array());
    EXPECT_EQ(number_at(12, 8, "id_material"), 1);
    EXPECT_EQ(info.at("materials").at(0), "Paint");
}

TEST_F(Layers, TwoEyesAreTheViewsOfAMultipartFile) {
    const std::vector<std::string> eyes = {"--stereo", "0.06", "--size", "8x8", "--aov", "depth"};
    const auto rendered = [&](const std::string& layout) {
        std::vector<std::string> options = eyes;
        options.insert(options.end(), {"-o", layout + ".exr", "--exr-layout", layout});
        expect_result(render("quad.gltf", options), 0, "OK");
        return OIIO::ImageInput::open((folder_ / (layout + ".exr")).string());
    };
    const auto whole = rendered("single");
    ASSERT_TRUE(whole);
    EXPECT_EQ(whole->spec().height, 8);
    const auto parts = rendered("multipart");
    ASSERT_TRUE(parts);
    std::vector<std::string> views;
    for (int part = 0; parts->seek_subimage(part, 0); ++part) {
        views.push_back(parts->spec().get_string_attribute("view"));
        EXPECT_EQ(parts->spec().height, 4);
        EXPECT_EQ(parts->spec().get_string_attribute("oiio:subimagename"),
                  (part % 2 == 0 ? "rgba-" : "depth-") + views.back());
    }
    EXPECT_EQ(views, (std::vector<std::string>{"left", "left", "right", "right"}));
}

TEST_F(Layers, ExrsAreStoredAsTheyAreAskedFor) {
    expect_result(
        shot({"-o", "a.exr", "--compression", "dwaa:30", "--exr-tiles", "8", "--exr-mipmap"}),
        0,
        "OK");
    const auto image = read_image_file(folder_ / "a.exr");
    ASSERT_TRUE(image);
    EXPECT_EQ(image->spec.tile_width, 8);
    EXPECT_EQ(image->spec.get_string_attribute("compression"), "zip") << "data stay whole";
    expect_result(render("quad.gltf", {"-o", "b.exr", "--compression", "piz"}), 0, "OK");
    EXPECT_EQ(read_image_file(folder_ / "b.exr")->spec.get_string_attribute("compression"), "piz");
    expect_result(
        render("quad.gltf", {"-o", "b.exr", "--compression", "zip:3"}), 64, "E-USAGE-CONFLICT");
}

}  // namespace
}  // namespace obscura
