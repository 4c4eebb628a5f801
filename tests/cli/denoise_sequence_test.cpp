// tests/cli/denoise_sequence_test.cpp - obscura denoise --frames: frames beside a frame help it.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include "cli/sliding_box.h"

namespace obscura {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class DenoiseSequence : public Cli {
protected:
    void SetUp() override {
        Cli::SetUp();
        folder_.write("slide.gltf", sliding_box());
    }
    ProgramRun shot(const std::vector<std::string>& more) const {
        std::vector<std::string> all = {"--spp", "8"};
        if (std::find(more.begin(), more.end(), "--size") == more.end())
            all.insert(all.end(), {"--size", "64x48"});
        all.insert(all.end(), more.begin(), more.end());
        return render("slide.gltf", all);
    }
    /// Frames 20 to 22, noisy.
    void render_noisy(const std::vector<std::string>& more) const {
        std::vector<std::string> all = {
            "--frames", "20-22", "--denoising-data", "-o", "n.####.exr"};
        all.insert(all.end(), more.begin(), more.end());
        expect_result(shot(all), 0, "OK");
    }
    ProgramRun denoise(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), "denoise");
        return run(std::move(arguments));
    }
    std::string done(const std::string& file) const {
        return read_image_file(folder_ / file).value().spec.get_string_attribute("obscura:denoise");
    }
    std::vector<float> pixels(const std::string& file) const {
        return read_image_file(folder_ / file).value().pixels;
    }
    std::string bytes(const std::string& file) const { return read_text(folder_ / file); }
};

TEST_F(DenoiseSequence, FramesBesideHelpWhereMotionIsKnown) {
    render_noisy({"--aov", "motion", "--animate-seed"});
    const ProgramRun got =
        denoise({"n.####.exr", "--frames", "20-22", "-o", "c.####.exr", "-o", "c.{frame:02}.png"});
    expect_result(got, 0, "OK");
    EXPECT_THAT(got.err, Not(HasSubstr("WARN")));
    EXPECT_THAT(done("c.0020.exr"), AllOf(HasSubstr("frame after"), Not(HasSubstr("before"))));
    EXPECT_THAT(done("c.0021.exr"), HasSubstr("depth, frame before, frame after;"));
    EXPECT_THAT(done("c.0022.exr"), AllOf(HasSubstr("frame before"), Not(HasSubstr("after"))));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "c.22.png"));
    // Which frames are asked for does not matter, but what there is beside them does.
    expect_result(denoise({"n.####.exr", "--frames", "21", "-o", "d.####.exr"}), 0, "OK");
    EXPECT_EQ(bytes("d.0021.exr"), bytes("c.0021.exr"));
    expect_result(denoise({"n.0021.exr", "-o", "alone.exr"}), 0, "OK");
    EXPECT_NE(pixels("alone.exr"), pixels("c.0021.exr"));
}

TEST_F(DenoiseSequence, SaysWhatHelpsLess) {
    render_noisy({});
    ProgramRun got = denoise({"n.####.exr", "--frames", "20-22", "-o", "c.####.exr"});
    expect_result(got, 0, "OK");
    EXPECT_THAT(got.err, HasSubstr("--frames: without the layer motion"));
    EXPECT_THAT(got.err, HasSubstr("warnings=1"));
    expect_result(denoise({"n.0021.exr", "-o", "alone.exr"}), 0, "OK");
    EXPECT_EQ(bytes("c.0021.exr"), bytes("alone.exr"));
    const ProgramRun apart = denoise({"n.####.exr", "--frames", "20-22", "-o", "c.####.exr"});
    EXPECT_THAT(apart.err, HasSubstr("frame 22 is written, 3 of 3"));
    std::filesystem::copy(folder_ / "n.0021.exr", folder_ / "m.0021.exr");
    got = denoise({"m.####.exr", "--frames", "21", "-o", "c.####.exr"});
    EXPECT_THAT(got.err, HasSubstr("--frames: no frame had one beside it"));
    render_noisy({"--aov", "motion"});
    got = denoise({"n.####.exr", "--frames", "21", "-o", "c.####.exr"});
    expect_result(got, 0, "OK");
    EXPECT_THAT(got.err, HasSubstr("the frames have the same random numbers"));
}

TEST_F(DenoiseSequence, RefusesFramesThatDoNotFit) {
    const auto refused = [&](const std::string& id, const std::string& text) {
        const ProgramRun got = denoise({"n.####.exr", "--frames", "21", "-o", "c.####.exr"});
        expect_result(got, 65, id);
        EXPECT_THAT(got.err, AllOf(HasSubstr("n.0022.exr"), HasSubstr(text)));
        EXPECT_FALSE(std::filesystem::exists(folder_ / "c.0021.exr"));
    };
    render_noisy({"--aov", "motion"});
    const auto replace_last = [&](const std::vector<std::string>& more) {
        std::vector<std::string> all = {"--frames", "22", "-o", "n.####.exr"};
        all.insert(all.end(), more.begin(), more.end());
        expect_result(shot(all), 0, "OK");
    };
    replace_last({"--aov", "motion", "--denoising-data", "--crop", "0,0,32,48"});
    refused("E-DENOISE-SOURCE", "its size is '32x48'; expected '64x48'");
    replace_last({"--aov", "motion", "--denoising-data", "--crop", "0,0,64,48", "--size", "64x50"});
    refused("E-DENOISE-SOURCE", "its place is '0,0 of 64x50'; expected '0,0 of 64x48'");
    replace_last({"--aov", "motion", "--denoising-data", "--integrator", "direct"});
    refused("E-DENOISE-SOURCE", "obscura:integrator is 'direct'; expected 'path'");
    replace_last({"--aov", "motion", "--denoising-data", "--color-space", "acescg"});
    refused("E-DENOISE-SOURCE", "colorInteropID is 'lin_ap1_scene'");
    replace_last({"--aov", "motion,diffuse_direct", "--denoising-data"});
    refused("E-DENOISE-SOURCE", "its layers of the light is 'diffuse_direct'");
    replace_last({"--denoising-data"});
    refused("E-DENOISE-LAYER", "motion");
    replace_last({"--aov", "motion"});
    refused("E-DENOISE-LAYER", "half_1");
}

TEST_F(DenoiseSequence, NeedsNamesForEveryFrame) {
    render_noisy({"--aov", "motion"});
    const std::string before = bytes("n.0021.exr");
    const auto refused = [&](std::vector<std::string> arguments, const char* id) {
        arguments.insert(arguments.end(), {"--frames", "20-22"});
        expect_result(denoise(std::move(arguments)), 64, id);
    };
    refused({"n.####.exr", "-o", "n.####.exr"}, "E-USAGE-SAMEFILE");
    refused({"n.####.exr", "-o", "n.{frame:04}.exr"}, "E-USAGE-SAMEFILE");
    refused({"n.####.exr", "-o", "c.exr"}, "E-USAGE-CONFLICT");
    refused({"n.####.exr", "-o", "c.png"}, "E-USAGE-CONFLICT");
    refused({"n.0021.exr", "-o", "c.####.exr"}, "E-USAGE-CONFLICT");
    refused({"n.####.exr", "-o", "{asset}.####.exr"}, "E-USAGE-CONFLICT");
    refused({"n.####.exr", "-o", "c.####.exr", "-o", "c.{frame:04}.exr"}, "E-USAGE-SAMEFILE");
    refused({"n.####.exr", "-o", "c.####.png", "-o", "c.{frame:04}.png"}, "E-USAGE-SAMEFILE");
    EXPECT_EQ(bytes("n.0021.exr"), before);
    const ProgramRun missing = denoise({"n.####.exr", "--frames", "22,23", "-o", "c.####.exr"});
    expect_result(missing, 66, "E-EXR-MISSING");
    EXPECT_THAT(missing.err, HasSubstr("n.0023.exr"));
    std::filesystem::create_directory(folder_ / "c.0022.exr");
    const auto folder = denoise({"n.####.exr", "--frames", "21,22", "-o", "c.####.exr"});
    expect_result(folder, 73, "E-OUT-CREATE");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "c.0021.exr")) << "known before the first frame";
}

/// A turntable's camera is none of the file: motion does not tell of it.
TEST_F(DenoiseSequence, AFrameIsLeftAloneWhoseCameraMovesUntold) {
    expect_result(
        shot({"--turntable", "12", "--aov", "motion", "--denoising-data", "-o", "t.##.exr"}),
        0,
        "OK");
    const ProgramRun got = denoise({"t.##.exr", "--frames", "2", "-o", "c.##.exr"});
    expect_result(got, 0, "OK");
    EXPECT_THAT(got.err, HasSubstr("--frames: the camera differs from frame to frame"));
    EXPECT_THAT(done("c.02.exr"), Not(HasSubstr("frame before")));
}

/// A frame has the random numbers of its own number behind --seed.
TEST_F(DenoiseSequence, AnimatedSeedsAreSeedsOfTheirOwn) {
    const auto colors = [&](const std::vector<std::string>& options, const std::string& file) {
        std::vector<std::string> all = {"--animation", "none", "-o", "####.exr"};
        if (options[0] != "--frames") all.back() = file;
        all.insert(all.end(), options.begin(), options.end());
        expect_result(shot(all), 0, "OK");
        return pixels(file);
    };
    const auto animated = colors({"--frames", "3-4", "--animate-seed", "--seed", "7"}, "0003.exr");
    EXPECT_EQ(animated, colors({"--seed", "10"}, "ten.exr"));
    EXPECT_NE(animated, pixels("0004.exr"));
    colors({"--frames", "3-4"}, "0003.exr");
    EXPECT_EQ(pixels("0003.exr"), pixels("0004.exr"));
    expect_result(shot({"--animate-seed", "-o", "a.exr"}), 64, "E-USAGE-CONFLICT");
}

}  // namespace
}  // namespace obscura
