// tests/cli/usage_test.cpp - help, versions, and every way to get the command line wrong.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"

namespace obscura {
namespace {

using testing::HasSubstr;

class Usage : public Cli {};

TEST_F(Usage, HelpIsForPeople) {
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"--help"}, {"render", "--help"}, {"info", "-h"}}) {
        const ProgramRun got = run(arguments);
        EXPECT_EQ(got.code, 0);
        EXPECT_THAT(got.out, HasSubstr("Usage: obscura"));
        EXPECT_THAT(got.out, HasSubstr("Examples:"));
        EXPECT_EQ(got.err, "");
        for (const std::string& line : lines_of(got.out))
            EXPECT_LE(line.size(), 100U) << line;
    }
    const std::string help = run({"render", "--help"}).out;
    for (const char* option :
         {"-o,--output",     "--size",         "--spp",          "--depth",
          "--seed",          "--threads",      "--isa",          "--scene",
          "--variant",       "--camera",       "--camera-model", "--eye",
          "--target",        "--up",           "--fov",          "--env",
          "--env-intensity", "--background",   "--integrator",   "--view",
          "--display",       "--filter",       "--ao-distance",  "--ocio",
          "--exposure",      "--float",        "--tile-size",    "--crop",
          "--stats",         "--quiet",        "--verbose",      "--env-rotation",
          "--fstop",         "--lens-radius",  "--focus-on",     "--focus-distance",
          "--blades",        "--aperture",     "--fisheye",      "--environment",
          "--stereo",        "--align",        "--distortion",   "--shift",
          "--sensor",        "--focal-length", "--mag",          "--near",
          "--far",           "--ev100",        "--shutter",      "--iso",
          "--camera-json",   "--anamorphic",   "--fisheye-fit",  "--strict",
          "--lenient",       "--check",        "--occlusion",    "--animation"}) {
        EXPECT_THAT(help, HasSubstr("  " + std::string(option) + " ")) << option;
    }
}

TEST_F(Usage, ShortFormsStandForLongOnes) {
    EXPECT_EQ(run({"help"}).out, run({"--help"}).out);
    EXPECT_EQ(run({"help", "info"}).out, run({"info", "--help"}).out);
    expect_result(run({"box.gltf", "--size", "8x8", "--spp", "1"}), 0, "OK");
    EXPECT_TRUE(std::filesystem::exists(folder_ / "box.png"));
    expect_result(run({"box.gltf", "--size", "8x8", "--spp", "1", "-o", "own.exr"}), 0, "OK");
    EXPECT_TRUE(std::filesystem::exists(folder_ / "own.exr"));
}

TEST_F(Usage, WhatIsNoSceneIsNamed) {
    folder_.write("mesh.obj", "# a comment\nv 0 0 0\n");
    folder_.write("beauty", std::string("v/1\x01", 4));
    const std::vector<std::pair<std::string, std::string>> files = {
        {"mesh.obj", "an OBJ scene"}, {"beauty", "an OpenEXR picture"}, {"beauty.exr", "no scene"}};
    for (const auto& [file, says] : files) {
        const ProgramRun got = run({"render", file});
        expect_result(got, 65, "E-GLB-FORMAT");
        EXPECT_THAT(got.err, HasSubstr(says));
    }
    const ProgramRun url = run({"render", "https://example.org/box.glb"});
    expect_result(url, 66, "E-SCENE-MISSING");
    EXPECT_THAT(url.err, HasSubstr("network"));
}

TEST_F(Usage, VersionNamesTheParts) {
    const ProgramRun got = run({"--version"});
    EXPECT_EQ(got.code, 0);
    EXPECT_THAT(got.out,
                testing::MatchesRegex("obscura [0-9.]+\nEmbree [0-9.]+\ncompiled by .+\n"));
}

struct Wrong {
    std::vector<std::string> arguments;
    const char* id;
    const char* message;  ///< must be part of what is said
};

const std::vector<Wrong> mistakes = {
    {{}, "E-USAGE", "obscura render SCENE"},
    {{"paint", "x.gltf"}, "E-USAGE", "'paint' is no command"},
    {{"help", "paint"}, "E-USAGE", "'paint' is no command"},
    {{"x.obj"}, "E-USAGE", "a scene alone (.gltf or .glb), or `batch`, `dataset`"},
    {{"render"}, "E-USAGE", "SCENE is required"},
    {{"info"}, "E-USAGE", "SCENE is required"},
    {{"render", "box.gltf", "--sp", "3"}, "E-USAGE", "did you mean --spp?"},
    {{"render", "box.gltf", "-x"}, "E-USAGE", "no such option"},
    {{"render", "box.gltf", "--denoise=best"}, "E-USAGE", "--denoise: it is given or left out"},
    {{"render", "box.gltf", "--eye", "1", "2", "3"}, "E-USAGE", "--eye 1,2,3"},
    {{"info", "box.gltf", "quad.gltf"}, "E-USAGE", "one argument too many"},
    {{"render", "box.gltf", "--spp", "1", "2"}, "E-USAGE", "one argument too many"},
    {{"render", "box.gltf", "--spp"}, "E-USAGE", "with one value"},
    {{"render", "box.gltf", "--spp", "1", "--spp", "2"}, "E-USAGE", "the option once"},
    {{"render", "box.gltf", "--spp", "0"}, "E-USAGE-RANGE", "1 to 1048576"},
    {{"render", "box.gltf", "--spp", "1099511627776"}, "E-USAGE-RANGE", "1 to 1048576"},
    {{"render", "box.gltf", "--spp", "12abc"}, "E-USAGE-NUMBER", "whole number"},
    {{"render", "box.gltf", "--spp", ""}, "E-USAGE-NUMBER", "whole number"},
    {{"render", "box.gltf", "--size", "0x10"}, "E-USAGE-RANGE", "1280x720"},
    {{"render", "box.gltf", "--size", "-1x10"}, "E-USAGE-RANGE", "1280x720"},
    {{"render", "box.gltf", "--size", "abc"}, "E-USAGE-NUMBER", "1280x720"},
    {{"render", "box.gltf", "--size", "99999999999x1"}, "E-USAGE-RANGE", "1280x720"},
    {{"render", "box.gltf", "--size", "65536x65536"}, "E-USAGE-RANGE", "in all"},
    {{"render", "box.gltf", "--depth", "-1"}, "E-USAGE-RANGE", "0 to 1000"},
    {{"render", "box.gltf", "--seed", "-1"}, "E-USAGE-NUMBER", "from 0"},
    {{"render", "box.gltf", "--threads", "1025"}, "E-USAGE-RANGE", "0 to 1024"},
    {{"render", "box.gltf", "--isa", "sse"}, "E-USAGE-CHOICE", "auto, baseline, avx2, avx512"},
    {{"render", "box.gltf", "--tile-size", "0"}, "E-USAGE-RANGE", "1 to 256"},
    {{"render", "box.gltf", "--crop", "0,0,5"}, "E-USAGE-NUMBER", "X,Y,WIDTH,HEIGHT"},
    {{"render", "box.gltf", "--crop", "1270,0,20,5"}, "E-USAGE-CONFLICT", "1280x720"},
    {{"render", "box.gltf", "--fov", "180"}, "E-USAGE-RANGE", "0.01 to 179"},
    {{"render", "box.gltf", "--fov", "nan"}, "E-USAGE-NUMBER", "0.01 to 179"},
    {{"render", "box.gltf", "--eye", "1,2"}, "E-USAGE-NUMBER", "x,y,z"},
    {{"render", "box.gltf", "--eye", "1,2,inf"}, "E-USAGE-RANGE", "x,y,z"},
    {{"render", "box.gltf", "--camera-model", "box"}, "E-USAGE-CHOICE", "pinhole, orthographic"},
    {{"render", "box.gltf", "--integrator", "magic"}, "E-USAGE-CHOICE", "direct, raycast, ao"},
    {{"render", "box.gltf", "--filter", "sinc"}, "E-USAGE-CHOICE", "blackman-harris"},
    {{"render", "box.gltf", "--background", "red"}, "E-USAGE-NUMBER", "transparent"},
    {{"render", "box.gltf", "--background", "1,2"}, "E-USAGE-NUMBER", "transparent"},
    {{"render", "box.gltf", "--exposure", "1,5"}, "E-USAGE-NUMBER", "-50 to 50"},
    {{"render", "box.gltf", "--env-intensity", "-1"}, "E-USAGE-RANGE", "0 to 1e+09"},
    {{"render", "box.gltf", "--env", "sky"}, "E-USAGE-NUMBER", "sky:ELEVATION,AZIMUTH"},
    {{"render", "box.gltf", "--env-rotation", "cam"}, "E-USAGE-NUMBER", "camera"},
    {{"render", "box.gltf", "--light-group", "a=x", "--light-group", "a=y"},
     "E-LIGHT-GROUP",
     "two groups are called 'a'"},
    {{"render", "box.gltf", "--env", ""}, "E-USAGE-CONFLICT", "empty"},
    {{"render", "box.gltf", "--scene", ""}, "E-USAGE-CONFLICT", "empty"},
    {{"render", "box.gltf", "--variant", ""}, "E-USAGE-CONFLICT", "empty"},
    {{"render", "box.gltf", "--variant", "Blue"}, "E-VARIANT-UNKNOWN", "none"},
    {{"render", "box.gltf", "--ao-distance", "1"}, "E-USAGE-CONFLICT", "--integrator ao"},
    {{"render", "box.gltf", "--wire-width", "2"}, "E-USAGE-CONFLICT", "--integrator wireframe"},
    {{"render", "box.gltf", "--integrator", "wireframe", "--wire-width", "0"},
     "E-USAGE-RANGE",
     "1000"},
    {{"render", "box.gltf", "--quiet", "--verbose"}, "E-USAGE-CONFLICT", "--verbose"},
    {{"render", "box.gltf", "--camera", "0", "--eye", "1,1,1"}, "E-USAGE-CONFLICT", "--eye"},
    {{"render", "box.gltf", "-o", "out.tga"}, "E-OUT-FORMAT", ".exr, .png"},
    {{"render", "box.gltf", "-o", "out"}, "E-OUT-FORMAT", ".exr, .png"},
    {{"render", "box.gltf", "-o", ""}, "E-USAGE-CONFLICT", "empty"},
    {{"render", "box.gltf", "-o", "a.jpg", "--bits", "16"}, "E-USAGE-CONFLICT", "PNG and TIFF"},
    {{"render", "box.gltf", "-o", "a.webp", "--bits", "16"}, "E-USAGE-CONFLICT", "PNG and TIFF"},
    {{"render", "box.gltf", "-o", "-", "--format", "jpeg", "--bits", "16"},
     "E-USAGE-CONFLICT",
     "PNG and TIFF"},
    {{"render", "box.gltf", "-o", "a.png", "--bits", "12"}, "E-USAGE-CHOICE", "8, 16"},
    {{"render", "box.gltf", "-o", "a.jpg", "--quality", "0"}, "E-USAGE-RANGE", "1 to 100"},
    {{"render", "box.gltf", "-o", "a.webp", "--size", "16384x1"}, "E-OUT-FORMAT", "16383"},
    {{"render", "box.gltf", "-o", "a.png", "--page", "mauve"}, "E-USAGE-NUMBER", "#RRGGBB"},
    {{"render", "box.gltf", "-o", "a.png", "--page", "white", "--background", "1,1,1"},
     "E-USAGE-CONFLICT",
     "--background"},
    {{"render", "box.gltf", "-o", "a.png", "--format", "png"}, "E-USAGE-CONFLICT", "-o -"},
    {{"render", "box.gltf", "-o", "-", "--format", "gif"}, "E-USAGE-CHOICE", "png, jpeg"},
    {{"render", "box.gltf", "-o", "-", "-o", "-"}, "E-USAGE-SAMEFILE", "twice"},
    {{"render", "box.gltf", "-o", "-", "--frames", "1-2"}, "E-USAGE-CONFLICT", "one image"},
    {{"render", "box.gltf", "--camera", "Side"}, "E-CAM-UNKNOWN", "0 'Front', 1 'Top'"},
    {{"render", "box.gltf", "--camera", "9"}, "E-CAM-UNKNOWN", "0 'Front', 1 'Top'"},
    {{"render", "box.gltf", "--camera", "Twin"}, "E-CAM-AMBIGUOUS", "2 'Twin', 3 'Twin'"},
    {{"render", "box.gltf", "--eye", "1,1,1", "--target", "1,1,1"}, "E-CAM-VIEW", "same point"},
    {{"render", "box.gltf", "--scene", "Attic"}, "E-SCENE-UNKNOWN", "Main"},
    {{"render", "box.gltf", "--scene", "7"}, "E-SCENE-UNKNOWN", "Main"},
    {{"info", "box.gltf", "--scene", "Attic"}, "E-SCENE-UNKNOWN", "Main"},
};

TEST_F(Usage, EveryMistakeExitsWith64AndSaysWhatWouldBeAccepted) {
    const size_t files = folder_.file_count();
    for (const Wrong& wrong : mistakes) {
        std::string command;
        for (const std::string& argument : wrong.arguments)
            command += "'" + argument + "' ";
        SCOPED_TRACE(command);
        const ProgramRun got = run(wrong.arguments);
        expect_result(got, 64, wrong.id);
        EXPECT_THAT(got.err, HasSubstr(wrong.message));
        EXPECT_EQ(folder_.file_count(), files) << "nothing may be written";
    }
}

TEST_F(Usage, AnOutputNeverReplacesWhatIsRead) {
    folder_.write("scene.exr", gltf_text(box_scene()));
    std::filesystem::create_symlink("scene.exr", folder_ / "link.exr");
    std::filesystem::create_hard_link(folder_ / "scene.exr", folder_ / "hard.exr");
    const std::string before = read_whole_file(folder_ / "scene.exr");
    for (const char* output : {"scene.exr", "./scene.exr", "link.exr", "hard.exr"}) {
        SCOPED_TRACE(output);
        expect_result(render("scene.exr", {"-o", output}), 64, "E-USAGE-SAMEFILE");
    }
    expect_result(render("scene.exr"), 65, "E-GLB-FORMAT");
    expect_result(
        render("box.gltf", {"--env", "scene.exr", "-o", "scene.exr"}), 64, "E-USAGE-SAMEFILE");
    expect_result(render("box.gltf", {"-o", "a.png", "-o", "./a.png"}), 64, "E-USAGE-SAMEFILE");
    expect_result(
        render("box.gltf", {"-o", "a.png", "--stats", "box.gltf"}), 64, "E-USAGE-SAMEFILE");
    EXPECT_EQ(read_whole_file(folder_ / "scene.exr"), before);
}

TEST_F(Usage, ControlCharactersNeverReachTheTerminal) {
    const ProgramRun got = render("no\x1b[31m\nsuch.gltf", {"-o", "x.exr"});
    expect_result(got, 66, "E-SCENE-MISSING");
    EXPECT_THAT(got.err, HasSubstr("no\\x1b[31m\\x0asuch.gltf"));
    EXPECT_THAT(got.err, testing::Not(HasSubstr("\x1b")));
}

}  // namespace
}  // namespace obscura
