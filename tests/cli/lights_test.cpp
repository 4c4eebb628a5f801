// tests/cli/lights_test.cpp - lights of extensions through the whole program.
// SPDX-License-Identifier: Apache-2.0
#include "image/png_builder.h"

#include "cli/cli.h"
#include <nlohmann/json.hpp>

namespace obscura {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// The box with an environment of RGBD red and a measured lamp.
class Lights : public Cli {
protected:
    void SetUp() override {
        Cli::SetUp();
        const auto png = testing_images::PngBuilder(1, 1, 8, 6).finish({{255, 0, 0, 51}});
        folder_.write("face.png", {reinterpret_cast<const char*>(png.data()), png.size()});
        folder_.write("lamp.ies", "TILT=NONE\n1 1 1 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n5 5\n");
        json tree = json::parse(gltf_text(box_scene()));
        tree["images"] = {{{"uri", "face.png"}}};
        tree["extensionsRequired"] = {"EXT_lights_image_based"};
        tree["extensions"]["EXT_lights_image_based"]["lights"] = {
            {{"name", "red sky"},
             {"intensity", 2},
             {"specularImages", {{0, 0, 0, 0, 0, 0}}},
             {"specularImageSize", 1}}};
        tree["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
        tree["extensions"]["EXT_lights_ies"]["lights"] = {{{"name", "lamp"}, {"uri", "lamp.ies"}}};
        tree["nodes"][0]["extensions"]["EXT_lights_ies"]["light"] = 0;
        folder_.write("lit.gltf", tree.dump());
    }

    /// The upper left pixel of a small image: the environment behind the box.
    std::vector<float> corner(const std::vector<std::string>& more) const {
        std::vector<std::string> arguments = {"-o", "out.exr", "--eye", "0,0,9", "--fov", "60"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        expect_result(render("lit.gltf", arguments), 0, "OK");
        const auto image = read_image_file(folder_ / "out.exr");
        if (!image) return {};
        return {image->pixels.begin(), image->pixels.begin() + 3};
    }
};

TEST_F(Lights, TheFilesEnvironmentIsSeenUnlessAnotherIsChosen) {
    EXPECT_THAT(corner({}), testing::ElementsAre(10, 0, 0));
    EXPECT_THAT(corner({"--env-intensity", "3"}), testing::ElementsAre(30, 0, 0));
    EXPECT_THAT(corner({"--background", "0,1,0"}), testing::ElementsAre(0, 1, 0));
    const auto output = OIIO::ImageOutput::create((folder_ / "sky.hdr").string());
    const std::vector<float> grey(2 * 3, 0.5F);
    ASSERT_TRUE(output->open((folder_ / "sky.hdr").string(), OIIO::ImageSpec(2, 1, 3)) &&
                output->write_image(OIIO::TypeFloat, grey.data()) && output->close());
    EXPECT_THAT(corner({"--env", "sky.hdr"}), testing::ElementsAre(0.5F, 0.5F, 0.5F));
    EXPECT_THAT(render("lit.gltf", {"--env", "sky.hdr"}).err,
                HasSubstr("--env takes the place of the environment that the file brings"));
    EXPECT_THAT(render("lit.gltf").err, Not(HasSubstr("studio")));
}

TEST_F(Lights, EnvironmentsHaveNames) {
    EXPECT_THAT(corner({"--env", "white"}), testing::ElementsAre(1, 1, 1));
    const std::vector<float> sky = corner({"--env", "sky:50,0"});
    ASSERT_EQ(sky.size(), 3U);
    EXPECT_GT(sky[2], sky[0]);  // away from the sun it is blue
    expect_result(render("lit.gltf", {"--env", "sky:100,0"}), 64, "E-USAGE-RANGE");
    expect_result(render("lit.gltf", {"--env", "sky:10"}), 64, "E-USAGE-NUMBER");
    expect_result(render("lit.gltf", {"--env", "./white"}), 67, "E-ENV-MISSING");
}

TEST_F(Lights, InfoNamesThem) {
    const ProgramRun table = run({"info", "lit.gltf", "--explain"});
    expect_result(table, 0, "OK");
    EXPECT_THAT(table.out,
                HasSubstr("  honoured     EXT_lights_image_based: the finest level is the "
                          "environment; --env takes its place\n"));
    EXPECT_THAT(table.out, HasSubstr("  honoured     EXT_lights_ies\n"));
    const json info = json::parse(run({"info", "lit.gltf", "--json"}).out);
    EXPECT_EQ(info.at("environment"), "red sky");
    EXPECT_EQ(info.at("lights").at(0).at("type"), "profile");
    EXPECT_EQ(info.at("lights").at(0).at("name"), "lamp");
    EXPECT_THAT(run({"info", "lit.gltf"}).out, HasSubstr("'red sky'"));
}

TEST_F(Lights, TheOptionChoosesAmongTheFilesLights) {
    json tree = json::parse(gltf_text(box_scene()));
    tree["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "directional"}, {"name", "Sun"}, {"intensity", 2}}};
    tree["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    folder_.write("sun.gltf", tree.dump());
    const auto sum = [&](const std::string& choice) {
        expect_result(
            render("sun.gltf", {"-o", "sun.exr", "--float", "--lights", choice}), 0, "OK");
        const auto image = read_image_file(folder_ / "sun.exr");
        float out = 0;
        for (size_t i = 0; image && i < image->pixels.size(); i += 4)
            out += image->pixels[i];
        return out;
    };
    const float kept = sum("keep");
    EXPECT_GT(kept, 0);
    EXPECT_NEAR(sum("S*=3"), 3 * kept, 1e-4 * kept);
    EXPECT_THAT(render("sun.gltf").err, Not(HasSubstr("studio")));
    EXPECT_THAT(render("sun.gltf", {"--lights", "off"}).err, HasSubstr("built-in studio"));
    expect_result(render("sun.gltf", {"--lights", "Son=2"}), 64, "E-LIGHT-UNKNOWN");
    expect_result(render("sun.gltf", {"--lights", "Sun"}), 64, "E-USAGE-CHOICE");
    expect_result(render("sun.gltf", {"--lights", "Sun=-1"}), 64, "E-USAGE-RANGE");
}

TEST_F(Lights, HiddenPartsAreLeftOut) {
    json tree = json::parse(gltf_text(box_scene()));
    tree["nodes"][0]["name"] = "Crate";
    folder_.write("crate.gltf", tree.dump());
    EXPECT_THAT(render("crate.gltf", {"--hide", "Crate"}).err, HasSubstr("no triangles"));
    expect_result(render("crate.gltf", {"--hide", "Create"}), 64, "E-HIDE-UNKNOWN");
    expect_result(render("crate.gltf", {"--hide", ""}), 64, "E-USAGE-CONFLICT");
    for (const char* option : {"--holdout", "--camera-invisible", "--no-shadow", "--catcher"})
        expect_result(render("crate.gltf", {option, "Create"}), 64, "E-VISIBILITY-UNKNOWN");
    expect_result(render("crate.gltf", {"--catcher", "ground"}), 0, "OK");
}

TEST_F(Lights, DamagedProfilesAreRefused) {
    folder_.write("lamp.ies", "TILT=NONE\n1 1 1 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n5\n");
    const ProgramRun broken = render("lit.gltf");
    expect_result(broken, 65, "E-IES-SHORT");
    EXPECT_THAT(broken.err, HasSubstr("lit.gltf#/extensions/EXT_lights_ies/lights/0"));
}

}  // namespace
}  // namespace obscura
