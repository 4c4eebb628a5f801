// tests/cli/hostile_test.cpp - inputs and environments that would crash or hijack the process.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include <cmath>
#include <nlohmann/json.hpp>

namespace obscura {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class Hostile : public Cli {
protected:
    /// The lit square in a world of `world` metres, and once more under a node of its own.
    std::string two_squares(double world, const json& scale) const {
        json tree = json::parse(gltf_text(lit_quad_scene()));
        tree["nodes"][0]["scale"] = {world, world, world};
        tree["nodes"][0]["name"] = "floor";
        tree["scenes"][0]["nodes"].push_back(tree["nodes"].size());
        tree["nodes"].push_back({{"mesh", 0}, {"name", "speck"}, {"scale", scale}});
        folder_.write("squares.gltf", tree.dump());
        return "squares.gltf";
    }
    void expect_finite(const char* file) const {
        const std::optional<ReadImage> image = read_image_file(folder_ / file);
        ASSERT_TRUE(image);
        for (const float value : image->pixels)
            EXPECT_TRUE(std::isfinite(value));
    }
};

/// Embree's assertions end the process at rays that are not finite in an instance's space.
TEST_F(Hostile, InstancesTooSmallForTheWorldAreLeftOut) {
    for (const double world : {1.0, 1e6, 1e12}) {
        const double tiny = 1e-19 * world;
        const ProgramRun got = render(two_squares(world, {tiny, tiny, tiny}), {"-o", "a.exr"});
        expect_result(got, 0, "OK");
        EXPECT_THAT(got.err, HasSubstr("are not drawn: speck"));
        expect_finite("a.exr");
    }
}

/// A mesh is drawn even when flattened so far that no inverse exists.
TEST_F(Hostile, InstancesThatAreNearlyFlatAreDrawn) {
    for (const double world : {1e-3, 1.0, 1e3, 1e9}) {
        SCOPED_TRACE(world);
        const std::string scene = two_squares(world, {world, world, 1e-18 * world});
        const std::string wide = std::to_string(world);
        const ProgramRun got = render(
            scene,
            {"-o", "a.exr", "--integrator", "id", "--eye", "0,0," + wide, "--target", "0,0,0"});
        expect_result(got, 0, "OK");
        EXPECT_THAT(got.err, Not(HasSubstr("not drawn")));
    }
}

TEST_F(Hostile, CrowdsOfCopiesAreThinnedOut) {
    json tree = json::parse(gltf_text(lit_quad_scene()));
    for (int i = 0; i < 100; ++i) {
        tree["scenes"][0]["nodes"].push_back(tree["nodes"].size());
        tree["nodes"].push_back({{"mesh", 0}, {"name", "heap"}, {"translation", {0, 0, 1}}});
    }
    folder_.write("heap.gltf", tree.dump());
    const ProgramRun got = render("heap.gltf", {"-o", "a.exr"});
    expect_result(got, 0, "OK");
    EXPECT_THAT(got.err, HasSubstr("99 copies of meshes that lie exactly on others are not drawn"));
    EXPECT_THAT(got.err, HasSubstr("nodes: heap\n"));
}

TEST_F(Hostile, EmissionOf1e30GivesFinitePixels) {
    json tree = json::parse(gltf_text(lit_quad_scene()));
    tree["extensionsUsed"].push_back("KHR_materials_emissive_strength");
    tree["materials"][0]["emissiveFactor"] = {1, 1, 1};
    tree["materials"][0]["pbrMetallicRoughness"] = {{"roughnessFactor", 0.5}};
    tree["materials"][0]["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] =
        1e30;
    for (json& light : tree["extensions"]["KHR_lights_punctual"]["lights"])
        light["intensity"] = 1e30;
    folder_.write("sun.gltf", tree.dump());
    const ProgramRun got = render("sun.gltf", {"--float", "-o", "a.exr"});
    expect_result(got, 0, "OK");
    EXPECT_THAT(got.err, HasSubstr("numbers out of range are clamped: "));
    EXPECT_THAT(got.err, HasSubstr("emissiveStrength"));
    expect_finite("a.exr");
}

TEST_F(Hostile, ConfigsThatReferToThemselves) {
    folder_.write("circle.ocio",
                  "ocio_profile_version: 2\nroles: {default: lin, scene_linear: lin}\n"
                  "displays:\n  sRGB:\n    - !<View> {name: Film, colorspace: out}\n"
                  "colorspaces:\n  - !<ColorSpace> {name: lin}\n"
                  "  - !<ColorSpace>\n    name: out\n"
                  "    from_scene_reference: !<ColorSpaceTransform> {src: lin, dst: out}\n");
    const ProgramRun got = render("box.gltf", {"-o", "a.png", "--ocio", "circle.ocio"});
    expect_result(got, 78, "E-OCIO-CYCLE");
    EXPECT_THAT(got.err, HasSubstr("colour space 'out' -> colour space 'out'"));
}

#if !defined(__SANITIZE_ADDRESS__)
/// OpenImageIO would load every library of that ending from these folders.
TEST_F(Hostile, NoForeignPluginIsLoaded) {
    const std::string folder = OBSCURA_BINARY_DIR "/foreign_plugins";
    const std::string plugin = folder + "/foreign.imageio.so";
    ProgramSetup with = setup({"--version"}, folder_);
    with.environment.push_back("LD_PRELOAD=" + plugin);
    EXPECT_THAT(run_program_with(with).err, HasSubstr("foreign code runs"));
    with = setup(small_render("quad.gltf", {"-o", "a.png", "-o", "a.jpg"}), folder_);
    for (const char* variable : {"OIIO_LIBRARY_PATH=", "LD_LIBRARY_PATH="})
        with.environment.push_back(variable + folder);
    const ProgramRun got = run_program_with(with);
    expect_result(got, 0, "OK");
    EXPECT_THAT(got.err, Not(HasSubstr("foreign code runs")));
}
#endif

}  // namespace
}  // namespace obscura
