// tests/cli/faults_test.cpp - strict, lenient and --check: faulty scenes through the whole program.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include <nlohmann/json.hpp>

namespace obscura {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class Faults : public Cli {
protected:
    /// The lit square, whose base colour and roughness are images; its texture coordinates are its
    /// positions, read two by two.
    static json textured_quad() {
        json tree = json::parse(gltf_text(lit_quad_scene()));
        json& attributes = tree["meshes"][0]["primitives"][0]["attributes"];
        attributes["TEXCOORD_0"] = tree["accessors"].size();
        tree["accessors"].push_back(
            {{"bufferView", 0}, {"componentType", 5126}, {"type", "VEC2"}, {"count", 4}});
        tree["materials"][0]["pbrMetallicRoughness"] = {
            {"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 1}}}};
        tree["textures"] = {{{"source", 0}}, {{"source", 1}}};
        tree["images"] = {{{"uri", "absent.png"}}, {{"uri", "gone.png"}}};
        return tree;
    }
    std::string write(const json& tree) const {
        folder_.write("faulty.gltf", tree.dump());
        return "faulty.gltf";
    }
    std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
            names.push_back(entry.path().filename().string());
        std::sort(names.begin(), names.end());
        return names;
    }
};

TEST_F(Faults, TwoMissingImagesAreBothListed) {
    const ProgramRun got = render(write(textured_quad()), {"-o", "a.exr"});
    expect_result(got, 67, "E-RES-MISSING");
    EXPECT_EQ(result_of(got)->where, "faulty.gltf#/images/0/uri");
    EXPECT_THAT(got.err, HasSubstr("ERROR faulty.gltf#/images/0/uri: "));
    EXPECT_THAT(got.err, HasSubstr("ERROR faulty.gltf#/images/1/uri: "));
    EXPECT_THAT(got.err, HasSubstr(" [E-RES-MISSING]\n"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.exr"));
    EXPECT_EQ(render("faulty.gltf", {"--strict"}).err, got.err);
    EXPECT_EQ(render("faulty.gltf", {"--threads", "1"}).err, got.err);
}

TEST_F(Faults, LenientRendersMagenta) {
    const std::string scene = write(textured_quad());
    const ProgramRun got =
        render(scene, {"--lenient", "--integrator", "albedo", "-o", "a.exr", "--stats", "s.json"});
    expect_result(got, 0, "OK");
    EXPECT_EQ(result_of(got)->warnings, 2);
    EXPECT_THAT(got.err, HasSubstr("WARN faulty.gltf#/images/1/uri: "));
    const std::optional<ReadImage> image = read_image_file(folder_ / "a.exr");
    ASSERT_TRUE(image);
    const size_t centre_pixel = static_cast<size_t>(image->height / 2 * image->width) +
                                static_cast<size_t>(image->width / 2);
    const float* pixel = &image->pixels[centre_pixel * image->channels.size()];
    EXPECT_EQ((std::vector<float>{pixel[0], pixel[1], pixel[2]}), (std::vector<float>{1, 0, 1}));
    EXPECT_EQ(image->spec.get_string_attribute("obscura:degraded"),
              "textures=2 primitives=0 triangles=0");
    const json statistics = json::parse(read_whole_file(folder_ / "s.json"));
    EXPECT_EQ(statistics["lenient"], true);
    EXPECT_EQ(statistics["degraded"], (json{{"textures", 2}, {"primitives", 0}, {"triangles", 0}}));
}

TEST_F(Faults, WholeScenesAreNotMarked) {
    expect_result(render("quad.gltf", {"-o", "a.exr", "--stats", "s.json"}), 0, "OK");
    const std::optional<ReadImage> image = read_image_file(folder_ / "a.exr");
    ASSERT_TRUE(image);
    EXPECT_EQ(image->spec.get_string_attribute("obscura:degraded"), "");
    EXPECT_EQ(json::parse(read_whole_file(folder_ / "s.json"))["lenient"], false);
}

/// A change to the textured square, and the codes of strict and lenient rendering.
struct FaultCase {
    const char* name;
    const char* place;  ///< JSON pointer
    json value;
    int strict;
    int lenient;
};

const std::vector<FaultCase>& fault_cases() {
    static const std::vector<FaultCase> cases = {
        {"D1", "/images/0/uri", "absent.png", 67, 0},
        {"D14", "/images/0/uri", "../absent.png", 77, 77},
        {"C3", "/accessors/1/count", 0, 65, 0},
        {"C14", "/accessors/2/count", 3, 65, 0},
        {"F1", "/extensionsRequired", json::array({"EXT_wishful"}), 69, 0},
        {"F5", "/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord", 1, 65, 0},
        {"F5 set", "/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord", 8, 65, 0},
        {"B10", "/asset/version", "3.0", 69, 69},
        {"C20", "/buffers/0/uri", "absent.bin", 67, 67},
    };
    return cases;
}

/// --check ends as rendering does, and leaves no file.
TEST_F(Faults, CheckingForetellsTheExitCode) {
    const json grey =
        "data:image/png;base64,"
        "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNo"
        "AAAAggCBd81ytgAAAABJRU5ErkJggg==";
    for (const FaultCase& fault : fault_cases()) {
        SCOPED_TRACE(fault.name);
        json tree = textured_quad();
        for (json& image : tree["images"])
            image["uri"] = grey;
        tree[json::json_pointer(fault.place)] = fault.value;
        const std::string scene = write(tree);
        const std::vector<std::string> before = files();
        const ProgramRun strict = run({"render", scene, "--check"});
        EXPECT_EQ(strict.code, fault.strict) << strict.err;
        const ProgramRun lenient = run({"render", scene, "--check", "--lenient"});
        EXPECT_EQ(lenient.code, fault.lenient) << lenient.err;
        EXPECT_EQ(files(), before);
        EXPECT_EQ(strict.out, "");
        EXPECT_EQ(render(scene, {"--quiet"}).code, fault.strict);
        EXPECT_EQ(render(scene, {"--quiet", "--lenient"}).code, fault.lenient);
        std::filesystem::remove(folder_ / "faulty.exr");
    }
}

TEST_F(Faults, CheckingWritesNothing) {
    const std::vector<std::string> before = files();
    const ProgramRun got = render(
        "box.gltf", {"--check", "-o", "a.exr", "-o", "b.png", "--stats", "s.json", "--spp", "4"});
    expect_result(got, 0, "OK");
    EXPECT_THAT(got.err, HasSubstr("nothing was written"));
    EXPECT_THAT(got.err, Not(HasSubstr("rendered in")));
    EXPECT_EQ(files(), before);
    expect_result(run({"render", "box.gltf", "--check", "--frames", "0-3"}), 0, "OK");
    EXPECT_EQ(files(), before);
}

TEST_F(Faults, CheckingLooksAtEverythingThatRenderingReads) {
    expect_result(render("box.gltf", {"--check", "--camera", "Back"}), 64, "E-CAM-UNKNOWN");
    expect_result(
        render("box.gltf", {"--check", "--fstop", "2", "--focus-on", "9999,0"}), 64, "E-CAM-FOCUS");
    expect_result(render("box.gltf", {"--check", "--env", "a.hdr"}), 67, "E-ENV-MISSING");
    expect_result(render("box.gltf", {"--check", "-o", "no/a.exr"}), 73, "E-OUT-CREATE");
    expect_result(
        render("box.gltf", {"--check", "-o", "a.png", "--view", "Nice"}), 78, "E-OCIO-VIEW");
}

TEST_F(Faults, TheEnvironmentIsNeverReplaced) {  // J1
    const ProgramRun got = render("box.gltf", {"--lenient", "--env", "absent.hdr"});
    expect_result(got, 67, "E-ENV-MISSING");
}

TEST_F(Faults, OtherCommandsAreLenientToo) {
    const std::string scene = write(textured_quad());
    expect_result(run({"info", scene}), 67, "E-RES-MISSING");
    expect_result(run({"info", scene, "--lenient"}), 0, "OK");
    const std::vector<std::string> bench = {
        "bench", scene, "--size", "24x16", "--repeat", "1", "--view", "whole"};
    EXPECT_EQ(run(bench).code, 67);
    std::vector<std::string> lenient = bench;
    lenient.push_back("--lenient");
    EXPECT_EQ(run(lenient).code, 0);
    EXPECT_EQ(run({"crosscheck", scene, "--rays", "1k"}).code, 67);
    EXPECT_EQ(run({"crosscheck", scene, "--rays", "1k", "--lenient"}).code, 0);
}

TEST_F(Faults, StrictAndLenientContradict) {
    expect_result(render("box.gltf", {"--strict", "--lenient"}), 64, "E-USAGE-CONFLICT");
}

}  // namespace
}  // namespace obscura
