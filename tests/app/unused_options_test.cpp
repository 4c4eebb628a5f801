// tests/app/unused_options_test.cpp - options without effect are told of, and others are not.
// SPDX-License-Identifier: Apache-2.0
#include "app/unused_options.h"

#include <gmock/gmock.h>

namespace obscura::app {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

std::vector<std::string> warnings_of(RenderArguments arguments) {
    arguments.scene_file = "s.glb";
    const Result<RenderRequest> request = make_render_request(arguments);
    EXPECT_TRUE(request) << request.error().message;
    Log log;
    if (request) warn_of_unused_options(unused_options(arguments, *request), log);
    return log.warnings();
}

/// Options of EXRs, and those of other files.
RenderArguments all_options() {
    RenderArguments out;
    out.exr_layout = "multipart";
    out.compression = "zips";
    out.exr_tiles = "32";
    out.exr_mipmap = true;
    out.float32 = true;
    out.quality = "80";
    out.page = "white";
    out.no_dither = true;
    return out;
}

TEST(UnusedOptions, AreThoseOfOtherOutputs) {
    RenderArguments arguments = all_options();
    arguments.outputs = {"a.exr"};
    arguments.aovs = {"depth"};
    arguments.crypto_levels = "4";
    EXPECT_THAT(warnings_of(arguments),
                ElementsAre(StartsWith("--no-dither: "),
                            StartsWith("--quality: "),
                            StartsWith("--crypto-levels: ")));
    arguments.background = "env";
    arguments.view = "Raw";
    arguments.bits = "8";
    EXPECT_THAT(warnings_of(arguments),
                ElementsAre(StartsWith("--view: "),
                            StartsWith("--no-dither: "),
                            StartsWith("--page: "),
                            StartsWith("--bits: "),
                            StartsWith("--quality: "),
                            StartsWith("--crypto-levels: ")));
    arguments = all_options();
    arguments.bits = "16";
    arguments.outputs = {"a.png"};
    EXPECT_THAT(warnings_of(arguments),
                ElementsAre(StartsWith("--exr-layout: "),
                            StartsWith("--compression: "),
                            StartsWith("--exr-tiles: "),
                            StartsWith("--exr-mipmap: "),
                            StartsWith("--float: "),
                            StartsWith("--quality: ")));
}

TEST(UnusedOptions, ThoseAgainstFirefliesAreForLightThatChanceFinds) {
    RenderArguments arguments;
    arguments.outputs = {"a.exr"};
    arguments.clamp_direct = "4";
    arguments.clamp_indirect = "4";
    arguments.caustics = "off";
    arguments.regularize = true;
    EXPECT_THAT(warnings_of(arguments), IsEmpty());
    arguments.integrator = "direct";
    EXPECT_THAT(warnings_of(arguments), IsEmpty());
    arguments.integrator = "ao";
    EXPECT_THAT(warnings_of(arguments),
                ElementsAre(StartsWith("--clamp-direct: "),
                            StartsWith("--clamp-indirect: "),
                            StartsWith("--caustics: "),
                            StartsWith("--regularize: ")));
}

TEST(UnusedOptions, AreSeedsOfFramesWithoutNoise) {
    RenderArguments arguments;
    arguments.outputs = {"a.####.exr"};
    arguments.frames = "1-2";
    arguments.animate_seed = true;
    for (const char* noisy : {"path", "ao"}) {
        arguments.integrator = noisy;
        EXPECT_THAT(warnings_of(arguments), IsEmpty()) << noisy;
    }
    arguments.integrator = "raycast";
    EXPECT_THAT(warnings_of(arguments), ElementsAre(StartsWith("--animate-seed: ")));
}

TEST(UnusedOptions, AreNoneWhereOneOutputNeedsThem) {
    RenderArguments arguments = all_options();
    arguments.outputs = {"a.exr", "a.jpg"};
    arguments.aovs = {"crypto_object"};
    arguments.crypto_levels = "4";
    EXPECT_THAT(warnings_of(arguments), IsEmpty());
    RenderArguments unnamed = all_options();
    unnamed.writes_images = false;
    EXPECT_THAT(warnings_of(unnamed), IsEmpty()) << "there is no output at all";
}

}  // namespace
}  // namespace obscura::app
