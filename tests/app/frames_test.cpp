// tests/app/frames_test.cpp - the frames of a sequence and the options that ask for them.
// SPDX-License-Identifier: Apache-2.0
#include "app/frames.h"

#include "app/render_request.h"

#include <gtest/gtest.h>

#include <gmock/gmock.h>

namespace obscura::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

RenderArguments arguments_of(const std::vector<std::string>& outputs) {
    RenderArguments arguments;
    arguments.scene_file = "scene.glb";
    arguments.outputs = outputs;
    return arguments;
}

std::string id_of(const Result<RenderRequest>& request) {
    return request ? "" : request.error().id;
}

TEST(Frames, RangesAreRead) {
    const Result<FrameList> range = parse_frames("3-120", "--frames");
    ASSERT_TRUE(range);
    EXPECT_EQ(range->numbers.size(), 118U);
    EXPECT_EQ(range->numbers.front(), 3);
    EXPECT_EQ(range->numbers.back(), 120);
    EXPECT_EQ(range->time_s(12), 0.5);
    const auto numbers = [](const char* text) {
        const Result<FrameList> list = parse_frames(text, "--frames");
        return list ? list->numbers : std::vector<int>{};
    };
    EXPECT_THAT(numbers("7"), ElementsAre(7));
    EXPECT_THAT(numbers("1-10x3"), ElementsAre(1, 4, 7, 10));
    EXPECT_THAT(numbers("1-10x2,15"), ElementsAre(1, 3, 5, 7, 9, 15));
    EXPECT_THAT(numbers("9,1-3x5,8-10"), ElementsAre(9, 1, 8, 10)) << "each once, as ordered";
    EXPECT_THAT(numbers("999990-999999x9"), ElementsAre(999990, 999999));
    for (const char* text : {"",
                             "-",
                             "1-",
                             "-4",
                             "5-4",
                             "1-2-3",
                             "a-b",
                             "0x1-3",
                             "1000000",
                             "1-9x0",
                             "1-9x",
                             "1-9x-2",
                             "7x2",
                             "1,",
                             ",1",
                             "1,,2",
                             "1, 2",
                             "1-9x2x2"})
        EXPECT_FALSE(parse_frames(text, "--frames")) << text;
}

TEST(Frames, NumbersFillTheirPlace) {
    EXPECT_EQ(frame_file("out/shot.####.exr", 7), "out/shot.0007.exr");
    EXPECT_EQ(frame_file("#.png", 12), "12.png") << "more digits than places";
    EXPECT_EQ(frame_file("a##b.exr", 0), "a00b.exr");
    EXPECT_FALSE(frame_file("shot.exr", 7));
    EXPECT_FALSE(frame_file("##/shot.exr", 7)) << "folders are not numbered";
    EXPECT_FALSE(frame_file("#.#.exr", 7));
}

TEST(Shutter, AnIntervalBlursAndSecondsExpose) {
    RenderArguments arguments = arguments_of({"a.exr"});
    arguments.lens.shutter = "-0.25,0.5";
    arguments.fps = "30";
    const Result<RenderRequest> blurred = make_render_request(arguments);
    ASSERT_TRUE(blurred) << blurred.error().message;
    EXPECT_EQ(blurred->shutter->open, -0.25);
    EXPECT_EQ(blurred->shutter->close, 0.5);
    EXPECT_EQ(blurred->fps, 30);
    EXPECT_FALSE(blurred->camera.settings.shutter_s);
    for (const char* text : {"0,0", "0.5,0", "0,", ",1", "0,1,2", "a,b", "0,1e9"}) {
        arguments.lens.shutter = text;
        EXPECT_THAT(id_of(make_render_request(arguments)), testing::StartsWith("E-USAGE-")) << text;
    }
    arguments.fps.reset();
    arguments.lens.shutter = "1/125";
    arguments.lens.fstop = "8";
    const Result<RenderRequest> exposed = make_render_request(arguments);
    ASSERT_TRUE(exposed) << exposed.error().message;
    EXPECT_FALSE(exposed->shutter);
    EXPECT_EQ(exposed->camera.settings.shutter_s, 1.0 / 125);
}

TEST(Frames, ARequestBecomesItsImages) {
    RenderArguments arguments = arguments_of({"a.##.exr", "a.##.png"});
    arguments.frames = "9-10";
    arguments.fps = "5";
    const Result<RenderRequest> request = make_render_request(arguments);
    ASSERT_TRUE(request) << request.error().message;
    const std::vector<ListedImage> frames = list_images(*request, {})->images;
    ASSERT_EQ(frames.size(), 2U);
    EXPECT_EQ(frames[1].number, 10);
    EXPECT_EQ(frames[1].time_s, 2);
    EXPECT_EQ(frames[0].outputs, (std::vector<std::filesystem::path>{"a.09.exr", "a.09.png"}));
}

TEST(Frames, AStillIsOneImageAndMayHaveHashesInItsName) {
    RenderArguments arguments = arguments_of({"a#1.exr"});
    arguments.time = "1.5";
    const Result<RenderRequest> request = make_render_request(arguments);
    ASSERT_TRUE(request);
    EXPECT_EQ(request->load.time_s, 1.5);
    const std::vector<ListedImage> frames = list_images(*request, {})->images;
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_FALSE(frames[0].number);
    EXPECT_EQ(frames[0].time_s, 1.5);
    EXPECT_EQ(frames[0].outputs[0], "a#1.exr");
}

TEST(Frames, WithoutAnOutputTheSceneNamesTheFrames) {
    RenderArguments arguments = arguments_of({});
    arguments.frames = "1-2";
    const Result<RenderRequest> request = make_render_request(arguments);
    ASSERT_TRUE(request);
    EXPECT_EQ(list_images(*request, {})->images[1].outputs[0], "scene.0002.exr");
}

TEST(Frames, ContradictionsAreRefused) {
    RenderArguments plain = arguments_of({"shot.exr"});
    plain.frames = "1-2";
    const Result<RenderRequest> without = make_render_request(plain);
    EXPECT_EQ(id_of(without), "E-USAGE-CONFLICT");
    EXPECT_THAT(without.error().message, HasSubstr("shot.####.exr"));

    RenderArguments both = arguments_of({"#.exr"});
    both.frames = "1-2";
    both.time = "1";
    EXPECT_EQ(id_of(make_render_request(both)), "E-USAGE-CONFLICT");

    RenderArguments rate = arguments_of({"a.exr"});
    rate.fps = "30";
    EXPECT_EQ(id_of(make_render_request(rate)), "E-USAGE-CONFLICT");
    rate.aovs = {"motion"};
    const Result<RenderRequest> vectors = make_render_request(rate);
    ASSERT_TRUE(vectors) << vectors.error().message;
    EXPECT_EQ(vectors->load.frame_step_s, 1.0 / 30);

    RenderArguments clash = arguments_of({"a.#.exr", "a.##.exr"});
    clash.frames = "8-11";
    EXPECT_EQ(id_of(make_render_request(clash)), "E-USAGE-SAMEFILE") << "from frame 10 on";

    RenderArguments eaten = arguments_of({"sky.##.exr"});
    eaten.frames = "1-20";
    eaten.env = "sky.03.exr";
    EXPECT_EQ(id_of(make_render_request(eaten)), "E-USAGE-SAMEFILE");

    RenderArguments unnamed = arguments_of({"a.exr"});
    unnamed.animation = "";
    EXPECT_EQ(id_of(make_render_request(unnamed)), "E-USAGE-CONFLICT");
}

}  // namespace
}  // namespace obscura::app
