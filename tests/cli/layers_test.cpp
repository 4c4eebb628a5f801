// tests/cli/layers_test.cpp - layers beside the beauty, in every layout that EXRs have.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include <nlohmann/json.hpp>

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
