// tests/cli/failures_test.cpp - the exit codes of inputs, resources and configurations.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include <cmath>
#include <sys/resource.h>
#include <sys/stat.h>

namespace obscura {
namespace {

using testing::HasSubstr;

class Failures : public Cli {
protected:
    static std::string replaced(std::string text, const std::string& what, const std::string& by) {
        const size_t at = text.find(what);
        EXPECT_NE(at, std::string::npos) << what;
        return text.replace(at, what.size(), by);
    }
    std::string box_with(const std::string& what, const std::string& by) const {
        folder_.write("changed.gltf", replaced(gltf_text(box_scene()), what, by));
        return "changed.gltf";
    }
};

TEST_F(Failures, BadSceneData) {
    folder_.write("empty.glb", "");
    EXPECT_EQ(render("empty.glb").code, 65);
    folder_.write("text.gltf", "not a scene");
    EXPECT_EQ(render("text.gltf").code, 65);
    const ProgramRun got = render(box_with("\"count\": 8", "\"count\": 800"));
    EXPECT_EQ(got.code, 65);
    ASSERT_TRUE(result_of(got)) << got.err;
    EXPECT_THAT(result_of(got)->where, HasSubstr("changed.gltf#/accessors/0"));
    EXPECT_EQ(run({"info", "changed.gltf"}).code, 65);
}

TEST_F(Failures, AMissingScene) {
    std::filesystem::create_directory(folder_ / "folder.gltf");
    ASSERT_EQ(mkfifo((folder_ / "pipe.gltf").c_str(), 0600), 0);
    for (const char* scene : {"missing.gltf", "folder.gltf", "pipe.gltf", "/dev/zero"}) {
        SCOPED_TRACE(scene);
        expect_result(render(scene, {"-o", "a.exr"}), 66, "E-SCENE-MISSING");
        expect_result(run({"info", scene}), 66, "E-SCENE-MISSING");
    }
}

TEST_F(Failures, AMissingOrCorruptResource) {
    expect_result(render("box.gltf", {"--env", "missing.hdr"}), 67, "E-ENV-MISSING");
    folder_.write("broken.exr", "\x76\x2f\x31\x01 and nothing more");
    expect_result(render("box.gltf", {"--env", "broken.exr"}), 67, "E-ENV-CORRUPT");
    const std::string text = gltf_text(box_scene());
    const size_t begin = text.find("data:");
    folder_.write("nobuffer.gltf",
                  replaced(text, text.substr(begin, text.find('"', begin) - begin), "missing.bin"));
    expect_result(render("nobuffer.gltf"), 67, "E-RES-MISSING");
}

TEST_F(Failures, Unsupported) {
    EXPECT_EQ(render(box_with("\"version\": \"2.0\"", "\"version\": \"3.0\"")).code, 69);
    const ProgramRun got = render(box_with("\"scene\": 0",
                                           "\"extensionsRequired\": [\"EXT_wishful\"], "
                                           "\"extensionsUsed\": [\"EXT_wishful\"], \"scene\": 0"));
    expect_result(got, 69, "E-EXT-REQUIRED");
    EXPECT_THAT(got.err, HasSubstr("EXT_wishful"));
}

TEST_F(Failures, RefusedByPolicy) {
    const std::string text = gltf_text(box_scene());
    const size_t begin = text.find("data:");
    const std::string uri = text.substr(begin, text.find('"', begin) - begin);
    for (const char* other : {"../secret.bin", "/etc/passwd", "http://example.org/a.bin"}) {
        SCOPED_TRACE(other);
        folder_.write("escape.gltf", replaced(text, uri, other));
        expect_result(render("escape.gltf"), 77, "E-URI-REFUSED");
    }
}

/// A lamp of 1e20 candela, the most that there is, 1e-10 m above a square: its illuminance exceeds
/// every float.
TEST_F(Failures, SamplesThatAreNotFinite) {
    SmallScene scene = lit_quad_scene();
    for (float& coordinate : scene.positions)
        coordinate *= 1e-10f;
    scene.nodes = R"({"mesh": 0}, {"camera": 0, "translation": [0, 0, 3e-10]},
{"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0, 0, 1e-10]})";
    scene.more = replaced(scene.more, "\"directional\"", "\"point\"");
    scene.more = replaced(scene.more, "3.14159265", "1e30");
    folder_.write("bright.gltf", gltf_text(scene));
    const ProgramRun got = render("bright.gltf", {"-o", "a.exr", "--stats", "s.json"});
    expect_result(got, 76, "E-NONFINITE");
    EXPECT_THAT(got.err, HasSubstr("of 768 samples were not finite"));
    EXPECT_THAT(read_whole_file(folder_ / "s.json"), HasSubstr("\"nonfinite_samples\": "));
    const std::optional<ReadImage> image = read_image_file(folder_ / "a.exr");
    ASSERT_TRUE(image) << "the picture is written all the same";
    for (const float value : image->pixels)
        EXPECT_TRUE(std::isfinite(value));
    expect_result(run({"bench", "bright.gltf", "--size", "24x16", "--spp", "2", "--repeat", "1"}),
                  76,
                  "E-NONFINITE");
}

TEST_F(Failures, ColorConfiguration) {
    const ProgramRun view = render("box.gltf", {"-o", "a.png", "--view", "Nice"});
    expect_result(view, 78, "E-OCIO-VIEW");
    EXPECT_THAT(view.err, HasSubstr("Khronos PBR Neutral"));
    expect_result(render("box.gltf", {"-o", "a.png", "--display", "Wall"}), 78, "E-OCIO-DISPLAY");
    expect_result(render("box.gltf", {"-o", "a.png", "--ocio", "no.ocio"}), 78, "E-OCIO-FILE");
    expect_result(render("box.gltf", {"-o", "a.exr", "--view", "Nice"}), 0, "OK");
}

#if !defined(__SANITIZE_ADDRESS__)
TEST_F(Failures, OutOfMemory) {
    ProgramSetup limited = setup(
        {"render", "box.gltf", "--size", "20000x20000", "--spp", "1", "--threads", "1"}, folder_);
    limited.before_start = [] {
        const rlimit limit = {rlim_t{3} << 30, rlim_t{3} << 30};
        setrlimit(RLIMIT_AS, &limit);
    };
    const ProgramRun got = run_program_with(limited);
    EXPECT_EQ(got.code, 33) << got.err;
    ASSERT_TRUE(result_of(got)) << got.err;
    EXPECT_EQ(result_of(got)->code, 33);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "box.exr"));
}
#endif

}  // namespace
}  // namespace obscura
