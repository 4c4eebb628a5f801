// tests/cli/display_server_test.cpp - what a viewer is shown while the program renders.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include "support/fake_viewer.h"

namespace obscura {
namespace {

using testing::HasSubstr;
using Manner = FakeViewer::Manner;
using Texts = std::vector<std::string>;

class DisplayServer : public Cli {
protected:
    /// Renders with a viewer, and finds there what the file has, at x, y of the viewer's image.
    ViewedImage expect_file_shown(const Texts& options, int x = 0, int y = 0) {
        FakeViewer viewer(Manner::reads);
        const ProgramRun got = render(
            "box.gltf",
            joined({"--float", "-o", "a.exr", "--display-server", viewer.address()}, options));
        expect_result(got, 0, "OK");
        EXPECT_EQ(result_of(got)->warnings, 0) << got.err;
        const auto images = viewer.images();
        EXPECT_EQ(images.size(), 1);
        const auto file = read_image_file(folder_ / "a.exr");
        if (!file || !images.contains("a.exr (rendering)")) {
            ADD_FAILURE();
            return {};
        }
        const ViewedImage& image = images.at("a.exr (rendering)");
        EXPECT_EQ(image.channels, file->channels);
        EXPECT_EQ(image.part(x, y, file->width, file->height), file->pixels);
        return image;
    }
};

TEST_F(DisplayServer, PassesEndInWhatTheFileHas) {
    const ViewedImage image = expect_file_shown({"--size", "150x140", "--spp", "40"});
    EXPECT_EQ(image.width, 150);
    EXPECT_EQ(image.height, 140);
    EXPECT_GE(image.updates, 4);
}

TEST_F(DisplayServer, SoDoAdaptiveAndDenoisedImages) {
    expect_file_shown({"--spp", "auto", "--noise-target", "0.1"});
    expect_file_shown({"--size", "64x48", "--spp", "8", "--denoise"});
}

TEST_F(DisplayServer, SoDoChannelsOfOtherIntegrators) {
    EXPECT_EQ(expect_file_shown({"--integrator", "depth"}).channels, Texts{"Z"});
    EXPECT_EQ(expect_file_shown({"--integrator", "normal"}).channels, (Texts{"N.X", "N.Y", "N.Z"}));
}

TEST_F(DisplayServer, ACropLiesInItsPlaceAndOverscanIsShownToo) {
    const ViewedImage crop =
        expect_file_shown({"--size", "100x80", "--crop", "30,20,40,50"}, 30, 20);
    EXPECT_EQ(crop.width, 100);
    EXPECT_EQ(crop.height, 80);
    const ViewedImage overscan = expect_file_shown({"--overscan", "5"});
    EXPECT_EQ(overscan.width, 24 + 10);
    EXPECT_EQ(overscan.height, 16 + 10);
}

TEST_F(DisplayServer, EveryImageOfACommandIsOneThere) {
    FakeViewer viewer(Manner::reads);
    const ProgramRun got = render("box.gltf",
                                  {"--turntable",
                                   "3",
                                   "--float",
                                   "-o",
                                   "out/{frame:02}.exr",
                                   "--display-server",
                                   viewer.address()});
    expect_result(got, 0, "OK");
    const auto images = viewer.images();
    EXPECT_EQ(images.size(), 3);
    for (const auto& [name, image] : images) {
        const auto file = read_image_file(folder_ / name.substr(0, name.find(' ')));
        ASSERT_TRUE(file) << name;
        EXPECT_EQ(image.pixels, file->pixels) << name;
    }
}

TEST_F(DisplayServer, ThoseOfAJobToo) {
    folder_.write("job.json",
                  R"({"assets": ["box.gltf", "quad.gltf"], "outputs": ["{asset}.exr"],)"
                  R"( "options": {"size": "24x16", "spp": 2}})");
    FakeViewer viewer(Manner::reads);
    expect_result(run({"batch", "job.json", "--display-server", viewer.address()}), 0, "OK");
    EXPECT_EQ(viewer.images().size(), 2);
    folder_.write("bad.json",
                  R"({"assets": ["box.gltf"], "options": {"display-server": "127.0.0.1"}})");
    expect_result(run({"batch", "bad.json"}), 65, "E-JOB-KEY");
}

TEST_F(DisplayServer, PartsShowTheirTiles) {
    FakeViewer viewer(Manner::reads);
    const Texts options = {"--size", "64x64", "--float", "-o", "a.exr", "--part"};
    expect_result(
        render("box.gltf", joined(options, {"1/2", "--display-server", viewer.address()})),
        0,
        "OK");
    expect_result(render("box.gltf", joined(options, {"2/2"})), 0, "OK");
    expect_result(run({"merge", "a.exr.1-of-2.film", "a.exr.2-of-2.film"}), 0, "OK");
    const auto images = viewer.images();
    const auto file = read_image_file(folder_ / "a.exr");
    ASSERT_TRUE(file);
    const ViewedImage& image = images.at("a.exr (rendering 1 of 2)");
    ASSERT_EQ(image.pixels.size(), file->pixels.size());
    size_t equal = 0;
    for (size_t i = 0; i < file->pixels.size(); ++i) {
        if (image.pixels[i] == file->pixels[i]) ++equal;
        EXPECT_TRUE(image.pixels[i] == file->pixels[i] || image.pixels[i] == 0) << i;
    }
    EXPECT_GE(equal, file->pixels.size() / 2);
    expect_result(
        render(
            "box.gltf",
            joined(options, {"1/2", "--part-by", "samples", "--display-server", viewer.address()})),
        64,
        "E-USAGE-CONFLICT");
}

TEST_F(DisplayServer, ChangesNothingInFiles) {
    FakeViewer viewer(Manner::reads);
    const Texts options = {"--spp", "20", "--aov", "albedo"};
    expect_result(
        render("box.gltf", joined(options, {"-o", "a.exr", "--display-server", viewer.address()})),
        0,
        "OK");
    expect_result(render("box.gltf", joined(options, {"-o", "b.exr"})), 0, "OK");
    EXPECT_EQ(read_whole_file(folder_ / "a.exr"), read_whole_file(folder_ / "b.exr"));
}

TEST_F(DisplayServer, WhereNobodyListensOrSomebodyHangsUpRenderingGoesOn) {
    expect_result(render("box.gltf", {"-o", "a.exr"}), 0, "OK");
    const auto expected = read_image_file(folder_ / "a.exr");
    ASSERT_TRUE(expected);
    for (const Manner manner : {Manner::reads, Manner::closes_early}) {
        FakeViewer viewer(manner);
        const bool is_there = manner == Manner::closes_early;
        if (!is_there) viewer.finish();
        const Texts more = {"-o", "b.exr", "--spp", "2", "--display-server", viewer.address()};
        const Texts size = {"--turntable", "2", "-o", "{frame}.exr", "--size", "640x480"};
        const ProgramRun got =
            render("box.gltf", is_there ? joined(size, {more.begin() + 2, more.end()}) : more);
        expect_result(got, 0, "OK");
        EXPECT_EQ(result_of(got)->warnings, 1) << got.err;
        EXPECT_THAT(got.err, HasSubstr("WARN " + viewer.address() + ": the viewer "));
        EXPECT_THAT(got.err, HasSubstr("rendering goes on without it"));
        if (is_there) continue;
        const auto file = read_image_file(folder_ / "b.exr");
        ASSERT_TRUE(file);
        EXPECT_EQ(file->pixels, expected->pixels);
    }
}

TEST_F(DisplayServer, OneThatDoesNotReadHoldsNothingUp) {
    FakeViewer viewer(Manner::never_reads);
    const Texts options = {"--size", "1280x960", "--display-server", viewer.address()};
    ProgramSetup program =
        setup(small_render("box.gltf", joined(options, {"-o", "a.exr"})), folder_);
    program.time_limit_s = 60;
    const ProgramRun got = run_program_with(program);
    expect_result(got, 0, "OK");
    EXPECT_THAT(got.err, HasSubstr("takes the rest of the picture too slowly"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "a.exr"));
}

TEST_F(DisplayServer, ASignalIsNotHeldUpEither) {
    FakeViewer viewer(Manner::never_reads);
    ProgramSetup program = setup({"render",
                                  "box.gltf",
                                  "--size",
                                  "1280x960",
                                  "--spp",
                                  "512",
                                  "-o",
                                  "a.exr",
                                  "--display-server",
                                  viewer.address()},
                                 folder_);
    program.time_limit_s = 30;
    send_at(program, SIGTERM, "Progress: [1-9]");
    expect_result(run_program_with(program), 143, "E-STOPPED");
}

TEST_F(DisplayServer, AddressesAreChecked) {
    expect_result(render("box.gltf", {"--display-server", "host:0"}), 64, "E-USAGE-RANGE");
    expect_result(render("box.gltf", {"--display-server", ":1"}), 64, "E-USAGE-NUMBER");
}

}  // namespace
}  // namespace obscura
