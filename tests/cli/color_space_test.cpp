// tests/cli/color_space_test.cpp - images in other rendering spaces, from files to files.
// SPDX-License-Identifier: Apache-2.0
#include "image/png_builder.h"

#include "cli/cli.h"
#include <cmath>
#include <nlohmann/json.hpp>

namespace obscura {
namespace {

using nlohmann::json;
using testing::ElementsAre;

/// Rec.709 red in ACEScg, by colour-science 0.4 (Bradford).
constexpr float acescg_red[3] = {0.61310f, 0.07019f, 0.02062f};

class ColorSpaces : public Cli {
protected:
    /// The unlit square that fills the image, with these parts of its material.
    static json unlit_square(const json& material) {
        json tree = json::parse(gltf_text(lit_quad_scene()));
        tree["nodes"] = {{{"mesh", 0}, {"scale", {9, 9, 1}}},
                         {{"camera", 0}, {"translation", {0, 0, 3}}}};
        tree["scenes"][0]["nodes"] = {0, 1};
        tree["materials"][0] = material;
        tree["materials"][0]["extensions"]["KHR_materials_unlit"] = json::object();
        tree["extensionsUsed"] = {"KHR_materials_unlit", "KHR_lights_punctual"};
        return tree;
    }

    /// The pixel in the middle.
    std::vector<float> middle(const std::string& file) const {
        const auto image = read_image_file(folder_ / file);
        if (!image) return {};
        const auto at = image->pixels.begin() + (8 * 24 + 12) * 4;
        return {at, at + 3};
    }
    std::vector<float> seen(const std::string& scene, std::vector<std::string> more = {}) const {
        for (const char* word : {"--color-space", "acescg", "--float", "-o", "a.exr"})
            more.emplace_back(word);
        expect_result(render(scene, more), 0, "OK");
        return middle("a.exr");
    }
    static void expect_red(const std::vector<float>& found, const char* what, float factor = 1) {
        SCOPED_TRACE(what);
        ASSERT_EQ(found.size(), 3U);
        for (size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(found[c], factor * acescg_red[c], 2e-4f * factor);
    }
};

TEST_F(ColorSpaces, EveryKindOfColourIsConverted) {
    const json red = {{"baseColorFactor", {1, 0, 0, 1}}};
    folder_.write("factor.gltf", unlit_square({{"pbrMetallicRoughness", red}}).dump());
    expect_red(seen("factor.gltf"), "factor");

    const auto png = testing_images::PngBuilder(1, 1, 8, 6).finish({{255, 0, 0, 255}});
    folder_.write("red.png", {reinterpret_cast<const char*>(png.data()), png.size()});
    json textured =
        unlit_square({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    textured["images"] = {{{"uri", "red.png"}}};
    textured["textures"] = {{{"source", 0}}};
    // Any numbers lead to the one texel.
    textured["accessors"].push_back(textured["accessors"][0]);
    textured["accessors"][2]["type"] = "VEC2";
    textured["accessors"][2].erase("min");
    textured["accessors"][2].erase("max");
    textured["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = 2;
    folder_.write("texture.gltf", textured.dump());
    expect_red(seen("texture.gltf"), "texture");
    // A sequence decodes the image once.
    expect_result(
        render("texture.gltf", {"--frames", "1-2", "--color-space", "acescg", "-o", "f#.exr"}),
        0,
        "OK");
    EXPECT_EQ(middle("f1.exr"), middle("f2.exr"));

    json colored = unlit_square(json::object());
    const std::vector<float> colors = {1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0};
    const std::string bytes(reinterpret_cast<const char*>(colors.data()), colors.size() * 4);
    colored["buffers"].push_back(
        {{"byteLength", bytes.size()},
         {"uri", "data:application/octet-stream;base64," + base64(bytes)}});
    colored["bufferViews"].push_back({{"buffer", 1}, {"byteLength", bytes.size()}});
    colored["accessors"].push_back(
        {{"bufferView", 2}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 4}});
    colored["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = 2;
    folder_.write("vertices.gltf", colored.dump());
    expect_red(seen("vertices.gltf"), "vertex colours");

    json lamp = json::parse(gltf_text(lit_quad_scene()));
    lamp["extensions"]["KHR_lights_punctual"]["lights"][0]["color"] = {1, 0, 0};
    lamp["materials"][0]["extensions"]["KHR_materials_specular"]["specularFactor"] = 0;
    lamp["extensionsUsed"].push_back("KHR_materials_specular");
    folder_.write("lamp.gltf", lamp.dump());
    const std::vector<float> lit = seen("lamp.gltf", {"--integrator", "raycast"});
    ASSERT_EQ(lit.size(), 3U);
    expect_red(lit, "lamp", lit[0] / acescg_red[0]);

    expect_red(
        seen("triangle.gltf", {"--eye", "0,0,5", "--target", "0,0,9", "--background", "1,0,0"}),
        "background");
}

TEST_F(ColorSpaces, AnEnvironmentIsConverted) {
    const auto output = OIIO::ImageOutput::create((folder_ / "sky.exr").string());
    const std::vector<float> red = {3, 0, 0, 3, 0, 0};
    ASSERT_TRUE(output->open((folder_ / "sky.exr").string(), OIIO::ImageSpec(2, 1, 3)) &&
                output->write_image(OIIO::TypeFloat, red.data()) && output->close());
    const std::vector<std::string> away = {"--eye", "0,0,5", "--target", "0,0,9"};
    std::vector<std::string> more = {"--env", "sky.exr"};
    more.insert(more.end(), away.begin(), away.end());
    expect_red(seen("triangle.gltf", more), "environment", 3);
}

TEST_F(ColorSpaces, HeadersSayWhatIsInTheFile) {
    const auto header = [&](const std::string& space) {
        expect_result(render("quad.gltf", {"--color-space", space, "-o", "a.exr"}), 0, "OK");
        return read_image_file(folder_ / "a.exr")->spec;
    };
    const OIIO::ImageSpec spec = header("acescg");
    EXPECT_EQ(spec.get_string_attribute("colorInteropID"), "lin_ap1_scene");
    float xy[8] = {};
    const OIIO::TypeDesc eight(OIIO::TypeDesc::FLOAT, 8);
    ASSERT_TRUE(spec.getattribute("chromaticities", eight, xy));
    EXPECT_THAT(xy, ElementsAre(0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f));
    EXPECT_EQ(header("aces2065-1").get_string_attribute("colorInteropID"), "lin_ap0_scene");
    EXPECT_EQ(header("lin_rec2020").get_string_attribute("colorInteropID"), "lin_rec2020_scene");
    expect_result(render("quad.gltf", {"--color-space", "acescc"}), 78, "E-OCIO-SPACE");

    // The default is today's file.
    header("lin_rec709");
    expect_result(render("quad.gltf", {"-o", "b.exr"}), 0, "OK");
    EXPECT_EQ(without_fingerprints(read_whole_file(folder_ / "a.exr")),
              without_fingerprints(read_whole_file(folder_ / "b.exr")));
}

/// What is shown does not depend on the space, as long as colours are not multiplied.
TEST_F(ColorSpaces, DisplaysShowTheSame) {
    const json pale = {{"baseColorFactor", {0.2, 0.6, 0.35, 1}}, {"metallicFactor", 0}};
    json tree = json::parse(gltf_text(lit_quad_scene()));
    tree["materials"][0]["pbrMetallicRoughness"] = pale;
    folder_.write("pale.gltf", tree.dump());
    for (const char* view : {"Un-tone-mapped", "ACES 1.0 SDR", "Khronos PBR Neutral"}) {
        const auto shown = [&](const char* space) {
            expect_result(render("pale.gltf",
                                 {"--color-space",
                                  space,
                                  "--view",
                                  view,
                                  "--no-dither",
                                  "--integrator",
                                  "direct",
                                  "--background",
                                  "0.5,0.4,0.7",
                                  "-o",
                                  "a.png"}),
                          0,
                          "OK");
            return read_image_file(folder_ / "a.png")->pixels;
        };
        const std::vector<float> plain = shown("lin_rec709");
        for (const char* space : {"acescg", "aces2065-1", "lin_rec2020", "ACEScg"}) {
            const std::vector<float> other = shown(space);
            ASSERT_EQ(plain.size(), other.size());
            for (size_t i = 0; i < plain.size(); ++i)
                ASSERT_NEAR(plain[i], other[i], 1.01f / 255) << view << " " << space << " " << i;
        }
    }
    expect_result(render("pale.gltf", {"--integrator", "albedo", "-o", "a.png"}), 0, "OK");
    expect_result(
        render("pale.gltf", {"--integrator", "albedo", "--color-space", "acescg", "-o", "b.png"}),
        0,
        "OK");
    const auto a = read_image_file(folder_ / "a.png");
    const auto b = read_image_file(folder_ / "b.png");
    ASSERT_TRUE(a && b);
    for (size_t i = 0; i < a->pixels.size(); ++i)
        ASSERT_NEAR(a->pixels[i], b->pixels[i], 1.01f / 255);
}

}  // namespace
}  // namespace obscura
