// tests/cli/sequence_test.cpp - animated scenes at a time, and as a sequence of files.
// SPDX-License-Identifier: Apache-2.0
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include "cli/cli.h"
#include "cli/sliding_box.h"

namespace obscura {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Sequence : public Cli {
protected:
    void SetUp() override {
        Cli::SetUp();
        folder_.write("slide.gltf", sliding_box());
    }
    std::vector<float> pixels(const std::string& name) const {
        const auto image = read_image_file(folder_ / name);
        EXPECT_TRUE(image) << name;
        return image ? image->pixels : std::vector<float>();
    }
};

/// The mean over the shutter interval lies between; static pixels are equal to the last bit.
TEST_F(Sequence, AShutterBlursWhatMoves) {
    const auto at = [&](const std::vector<std::string>& options, const char* file) {
        std::vector<std::string> more = {"--spp", "64", "--time", "0", "-o", file};
        more.insert(more.end(), options.begin(), options.end());
        expect_result(render("slide.gltf", more), 0, "OK");
        return pixels(file);
    };
    const std::vector<float> sharp = at({}, "sharp.exr");
    const std::vector<float> blurred = at({"--shutter", "0,48"}, "blurred.exr");
    EXPECT_NE(sharp, blurred);
    EXPECT_EQ(at({"--animation", "none"}, "a.exr"),
              at({"--animation", "none", "--shutter", "0,48"}, "b.exr"));
    expect_result(render("slide.gltf", {"--shutter", "1,0", "-o", "c.exr"}), 64, "E-USAGE-RANGE");
}

TEST_F(Sequence, AMovedBoxIsSeenElsewhere) {
    const std::vector<std::string> depth = {"--integrator", "depth", "--time"};
    const auto at = [&](const char* time, const char* file) {
        std::vector<std::string> more = depth;
        more.insert(more.end(), {time, "-o", file});
        expect_result(render("slide.gltf", more), 0, "OK");
        return pixels(file);
    };
    const std::vector<float> left = at("0", "left.exr");
    const std::vector<float> right = at("2", "right.exr");
    ASSERT_EQ(left.size(), 24U * 16U);
    const size_t row = 8U * 24U;
    EXPECT_NEAR(left[row + 8], 5, 0.01) << "the front face, 6 m - 1 m away";
    EXPECT_EQ(right[row + 8], 0);
    EXPECT_NEAR(right[row + 15], 5, 0.01);
    EXPECT_EQ(left[row + 15], 0);
    expect_result(render("slide.gltf", {"--integrator", "depth", "-o", "rest.exr"}), 0, "OK");
    EXPECT_NEAR(pixels("rest.exr")[row + 12], 5, 0.01) << "as stored: in the middle";
}

TEST_F(Sequence, HeadersHaveTheRateAndATimeCodeWhereItIsCounted) {
    const auto header = [&](const char* frames, const char* fps, const char* file) {
        expect_result(
            render("slide.gltf", {"--frames", frames, "--fps", fps, "-o", "t.####.exr"}), 0, "OK");
        return Imf::InputFile((folder_ / file).c_str()).header();
    };
    const Imf::Header film = header("1465-1465", "24", "t.1465.exr");
    EXPECT_EQ(Imf::framesPerSecond(film).n, 24);
    EXPECT_EQ(Imf::framesPerSecond(film).d, 1U);
    const Imf::TimeCode& time = Imf::timeCode(film);
    EXPECT_EQ(time.minutes(), 1) << "1440 frames";
    EXPECT_EQ(time.seconds(), 1) << "24 more";
    EXPECT_EQ(time.frame(), 1);
    const Imf::Header television = header("30-30", "29.97", "t.0030.exr");
    EXPECT_EQ(Imf::framesPerSecond(television).n, 30000);
    EXPECT_EQ(Imf::timeCode(television).seconds(), 1) << "no frame is dropped";
    EXPECT_FALSE(Imf::hasTimeCode(header("1-1", "2", "t.0001.exr")));
    expect_result(render("slide.gltf", {"-o", "one.exr"}), 0, "OK");
    EXPECT_FALSE(Imf::hasFramesPerSecond(Imf::InputFile((folder_ / "one.exr").c_str()).header()));
}

TEST_F(Sequence, FramesAreEqualToSingleImages) {
    expect_result(render("slide.gltf",
                         {"--frames", "1-3", "--fps", "2", "-o", "f.##.exr", "--stats", "s.json"}),
                  0,
                  "OK");
    const char* times[] = {"0.5", "1", "1.5"};
    const double seconds[] = {0.5, 1, 1.5};
    for (int frame = 1; frame <= 3; ++frame) {
        const std::string file = "f.0" + std::to_string(frame) + ".exr";
        expect_result(render("slide.gltf", {"--time", times[frame - 1], "-o", "one.exr"}), 0, "OK");
        EXPECT_EQ(pixels(file), pixels("one.exr")) << file;
        const auto read = read_image_file(folder_ / file);
        const OIIO::ParamValue* time = read->spec.find_attribute("obscura:timeSeconds");
        ASSERT_NE(time, nullptr);
        ASSERT_EQ(time->type(), OIIO::TypeDesc::DOUBLE);
        EXPECT_EQ(time->get<double>(), seconds[frame - 1]);
    }
    EXPECT_NE(pixels("f.01.exr"), pixels("f.03.exr"));
    const json stats = json::parse(read_whole_file(folder_ / "s.json"));
    EXPECT_EQ(stats["fps"], 2);
    ASSERT_EQ(stats["frames"].size(), 3U);
    EXPECT_EQ(stats["frames"][2]["frame"], 3);
    EXPECT_EQ(stats["frames"][2]["time_s"], 1.5);
    EXPECT_EQ(stats["paths"], 3 * 24 * 16 * 2);
}

TEST_F(Sequence, TheAutomaticViewStandsStill) {
    json tree = json::parse(sliding_box());
    tree.erase("cameras");
    for (json& node : tree["nodes"])
        node.erase("camera");
    folder_.write("free.gltf", tree.dump());
    expect_result(render("free.gltf",
                         {"--frames", "0-4", "--fps", "2", "--integrator", "depth", "-o", "#.exr"}),
                  0,
                  "OK");
    EXPECT_NE(pixels("0.exr"), pixels("4.exr")) << "a view that followed would see no change";
}

TEST_F(Sequence, WhatContradictsIsRefused) {
    const ProgramRun got = render("slide.gltf", {"--frames", "1-2", "-o", "a.exr"});
    expect_result(got, 64, "E-USAGE-CONFLICT");
    EXPECT_THAT(got.err, HasSubstr("shot.####.exr"));
    expect_result(render("slide.gltf", {"--animation", "Jump"}), 64, "E-ANIM-UNKNOWN");
}

TEST_F(Sequence, InfoListsAnimations) {
    const ProgramRun text = run({"info", "slide.gltf"});
    EXPECT_THAT(text.out, HasSubstr("0 'Slide': 2 s, 1 channels"));
    const json data = json::parse(run({"info", "slide.gltf", "--json"}).out);
    EXPECT_EQ(data["animations"][0]["name"], "Slide");
    EXPECT_EQ(data["animations"][0]["duration_s"], 2);
    EXPECT_EQ(data["animations"][0]["channels"], 1);
}

TEST_F(Sequence, ASignalStopsBetweenFramesToo) {
    ProgramSetup program = setup({"render",
                                  "slide.gltf",
                                  "--size",
                                  "64x48",
                                  "--spp",
                                  "256",
                                  "--frames",
                                  "0-99",
                                  "-o",
                                  "s.#.exr",
                                  "--stats",
                                  "s.json"},
                                 folder_);
    program.on_output = [sent = false](const std::string& out, pid_t process) mutable {
        static const std::regex form("Progress: [0-9]+%\n(.|\n)*Progress");
        if (sent || !std::regex_search(out, form)) return;
        sent = true;
        kill(process, SIGTERM);
    };
    const ProgramRun got = run_program_with(program);
    EXPECT_EQ(got.code, 143);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "s.99.exr"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "s.json"));
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
        EXPECT_NE(entry.path().extension(), ".part") << entry.path();
}

}  // namespace
}  // namespace obscura
