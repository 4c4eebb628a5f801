// tests/cli/many_images_test.cpp - many images from one load: views, cameras, variants, turntables.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include "support/text_files.h"
#include <nlohmann/json.hpp>
#include <regex>
#include <sys/resource.h>

namespace obscura {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using Texts = std::vector<std::string>;

class ManyImages : public Cli {
protected:
    void SetUp() override {
        Cli::SetUp();
        json scene = json::parse(gltf_text(lit_quad_scene()));
        scene["extensionsUsed"].push_back("KHR_materials_variants");
        json& variants = scene["extensions"]["KHR_materials_variants"]["variants"];
        variants = json::parse(R"([{"name": "Red"}, {"name": "Blue/1"}])");
        const auto paint = [&](const char* name, double r, double g, double b) {
            scene["materials"].push_back(
                {{"name", name},
                 {"pbrMetallicRoughness",
                  {{"baseColorFactor", {r, g, b, 1}}, {"metallicFactor", 0}}}});
            return static_cast<int>(scene["materials"].size()) - 1;
        };
        const int red = paint("red", 1, 0, 0);
        const int blue = paint("blue", 0, 0, 1);
        json mappings = json::array();
        mappings.push_back({{"material", red}, {"variants", {0}}});
        mappings.push_back({{"material", blue}, {"variants", {1}}});
        scene["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] =
            mappings;
        folder_.write("quad.gltf", scene.dump());
    }
    std::string text(const std::string& name) const { return read_text(folder_ / name); }
    std::vector<json> lines(const std::string& manifest) const {
        std::vector<json> out;
        for (const std::string& line : split_lines(text(manifest)))
            out.push_back(json::parse(line));
        return out;
    }
    /// The same pixels; headers may name other things.
    void expect_same(const std::string& one, const std::string& other) const {
        const auto a = read_image_file(folder_ / one);
        const auto b = read_image_file(folder_ / other);
        ASSERT_TRUE(a && b) << one << ", " << other;
        EXPECT_TRUE(a->pixels == b->pixels) << one << ", " << other;
    }
    void expect_refused(const Texts& options,
                        const std::string& id,
                        const std::string& says) const {
        const ProgramRun got = render("quad.gltf", options);
        expect_result(got, 64, id);
        EXPECT_THAT(got.err, HasSubstr(says));
    }
};

TEST_F(ManyImages, VariantsAreThoseOfSingleCommands) {
    const Texts all = {"--variants", "all", "-o", "out/{asset}/{variant}.exr"};
    expect_result(render("quad.gltf", all), 0, "OK");
    for (const auto& [variant, file] : {std::pair{"Red", "Red"}, std::pair{"Blue/1", "Blue_1"}}) {
        expect_result(render("quad.gltf", {"--variant", variant, "-o", "one.exr"}), 0, "OK");
        expect_same("out/quad/" + std::string(file) + ".exr", "one.exr");
    }
    const auto red = read_image_file(folder_ / "out/quad/Red.exr");
    const auto blue = read_image_file(folder_ / "out/quad/Blue_1.exr");
    EXPECT_FALSE(red->pixels == blue->pixels);
    // A material's name hides what has it in this variant, not what had it in the one before.
    const Texts hidden = {"--variants", "Blue*,Red", "--hide", "red", "-o", "h/{variant}.exr"};
    expect_result(render("quad.gltf", hidden), 0, "OK");
    const Texts bare = {"--variant", "Red", "--hide", "red", "-o", "one.exr"};
    expect_result(render("quad.gltf", bare), 0, "OK");
    expect_same("h/Red.exr", "one.exr");
    expect_same("h/Blue_1.exr", "out/quad/Blue_1.exr");
    expect_refused({"--variants", "Green", "-o", "{variant}.exr"}, "E-VARIANT-UNKNOWN", "Red");
    // An asset without variants has one look.
    expect_result(render("box.gltf", {"--variants", "all", "-o", "{variant}.exr"}), 0, "OK");
    EXPECT_TRUE(fs::exists(folder_ / "default.exr"));
}

TEST_F(ManyImages, CamerasAreThoseOfSingleCommands) {
    expect_result(render("box.gltf", {"--cameras", "all", "-o", "{view}.exr"}), 0, "OK");
    const Texts names = {"Front", "Top", "Twin", "Twin-2"};
    for (size_t i = 0; i < names.size(); ++i) {
        expect_result(
            render("box.gltf", {"--camera", std::to_string(i), "-o", "one.exr"}), 0, "OK");
        expect_same(names[i] + ".exr", "one.exr");
    }
    expect_result(render("box.gltf", {"--cameras", "T*", "-o", "t/{view}.exr"}), 0, "OK");
    EXPECT_FALSE(fs::exists(folder_ / "t/Front.exr"));
    EXPECT_TRUE(fs::exists(folder_ / "t/Twin-2.exr"));
    const ProgramRun got = render("box.gltf", {"--cameras", "Side", "-o", "{view}.exr"});
    expect_result(got, 64, "E-CAM-UNKNOWN");
    EXPECT_THAT(got.err, HasSubstr("Front"));
}

TEST_F(ManyImages, TheFilesCamerasAreNeitherPlacedNorFramed) {
    for (const Texts& placing : {Texts{"--eye", "1,2,3"},
                                 Texts{"--target", "1,0,0"},
                                 Texts{"--up", "1,0,0"},
                                 Texts{"--azimuth", "20"},
                                 Texts{"--margin", "3"},
                                 Texts{"--frame", "sphere"},
                                 Texts{"--focus-node", "*"}}) {
        expect_refused(joined({"--cameras", "all", "-o", "x_{view}.png"}, placing),
                       "E-USAGE-CONFLICT",
                       "leave out " + placing.front());
    }
    EXPECT_FALSE(fs::exists(folder_ / "x_Front.png"));
}

TEST_F(ManyImages, ATurntableGoesRoundAtOneScale) {
    const Texts turn = {"--turntable", "4", "--azimuth", "10", "-o", "turn.##.exr"};
    expect_result(render("box.gltf", turn), 0, "OK");
    for (int i = 0; i < 4; ++i) {
        const std::string azimuth = std::to_string(10 + 90 * i);
        const Texts one = {"--azimuth", azimuth, "--frame", "sphere", "-o", "one.exr"};
        expect_result(render("box.gltf", one), 0, "OK");
        expect_same("turn.0" + std::to_string(i + 1) + ".exr", "one.exr");
    }
    EXPECT_FALSE(fs::exists(folder_ / "turn.05.exr"));
    expect_result(render("box.gltf", {"--turntable", "2"}), 0, "OK");
    EXPECT_TRUE(fs::exists(folder_ / "box.0002.exr"));
    for (const Texts& more : {Texts{"--frames", "1-2"},
                              Texts{"--eye", "1,2,3"},
                              Texts{"--camera", "0"},
                              Texts{"--cameras", "all"}}) {
        expect_refused(joined({"--turntable", "2", "-o", "{view}.##.exr"}, more),
                       "E-USAGE-CONFLICT",
                       "--turntable");
    }
}

TEST_F(ManyImages, ViewsAreThoseOfSingleCommands) {
    folder_.write("views.json", R"({"views": [
        {"name": "by hand", "eye": [1, 2, 3], "target": [0, 0.5, 0], "fov": 30},
        {"azimuth": 70, "elevation": 5, "zoom": 1.5, "variant": "Red"},
        {"name": "turned", "camera": "Front", "environment_rotation": 40,
         "environment_intensity": 2},
        {"name": "cv", "width": 32, "height": 16, "K": [[40, 0, 16], [0, 40, 8], [0, 0, 1]],
         "R": [[1, 0, 0], [0, -1, 0], [0, 0, -1]], "t": [0, 0, 4]}]})");
    folder_.write("cv.json", R"({"width": 32, "height": 16, "K": [[40, 0, 16], [0, 40, 8],
        [0, 0, 1]], "R": [[1, 0, 0], [0, -1, 0], [0, 0, -1]], "t": [0, 0, 4]})");
    const Texts env = {"--env", "sky:30,20"};
    const Texts all = {"--views", "views.json", "-o", "v/{view}.exr", "--manifest", "v.jsonl"};
    expect_result(render("quad.gltf", joined(env, all)), 0, "OK");
    const std::vector<std::pair<std::string, Texts>> singles = {
        {"by hand", {"--eye", "1,2,3", "--target", "0,0.5,0", "--fov", "30"}},
        {"view 1", {"--azimuth", "70", "--elevation", "5", "--zoom", "1.5", "--variant", "Red"}},
        {"turned", {"--camera", "Front", "--env-rotation", "40", "--env-intensity", "2"}},
        {"cv", {"--camera-json", "cv.json", "--size", "32x16"}}};
    for (const auto& [name, options] : singles) {
        expect_result(
            render("quad.gltf", joined(joined(env, options), {"-o", "one.exr"})), 0, "OK");
        expect_same("v/" + name + ".exr", "one.exr");
    }
    const std::vector<json> told = lines("v.jsonl");
    ASSERT_EQ(told.size(), 4U);
    const json& cv = told[2].at("view") == "cv"   ? told[2]
                     : told[1].at("view") == "cv" ? told[1]
                                                  : told[3];
    EXPECT_EQ(cv.at("camera").at("width"), 32);
    EXPECT_NEAR(cv.at("camera").at("K")[0][0].get<double>(), 40, 1e-4);
    EXPECT_NEAR(cv.at("camera").at("K")[1][2].get<double>(), 8, 1e-4);
    EXPECT_NEAR(cv.at("camera").at("R")[1][1].get<double>(), -1, 1e-6);
    EXPECT_NEAR(cv.at("camera").at("t")[2].get<double>(), 4, 1e-6);
}

TEST_F(ManyImages, AFolderThatCannotBeMadeFailsItsImagesAlone) {
    folder_.write("views.json", R"({"views": [{"name": "a"}, {"name": "b"}, {"name": "c"}]})");
    fs::create_directory(folder_ / "r");
    folder_.write("r/b", "a file");
    const Texts options = {"--views", "views.json", "--manifest", "m.jsonl"};
    const ProgramRun got = render("box.gltf", joined(options, {"-o", "r/{view}/x.png"}));
    expect_result(got, 73, "E-OUT-CREATE");
    EXPECT_THAT(got.err, HasSubstr("1 of 3 images failed; the first: b: "));
    EXPECT_TRUE(fs::exists(folder_ / "r/a/x.png") && fs::exists(folder_ / "r/c/x.png"));
    EXPECT_EQ(lines("m.jsonl").size(), 3U);
    // Where none can be written, nothing is rendered.
    expect_result(
        render("box.gltf", joined(options, {"-o", "r/b/{view}.png"})), 73, "E-OUT-CREATE");
}

TEST_F(ManyImages, OneFailureDoesNotEndTheRest) {
    folder_.write("views.json", R"({"views": [
        {"name": "a", "azimuth": 10}, {"name": "bad", "eye": [0, 0, 0], "target": [0, 0, 0]},
        {"name": "worse", "camera": "none"}, {"name": "b", "azimuth": 20}]})");
    const ProgramRun got =
        render("box.gltf", {"--views", "views.json", "-o", "{view}.exr", "--manifest", "m.jsonl"});
    expect_result(got, 64, "E-CAM-VIEW");
    EXPECT_THAT(got.err, HasSubstr("2 of 4 images failed; the first: bad: "));
    EXPECT_TRUE(fs::exists(folder_ / "a.exr") && fs::exists(folder_ / "b.exr"));
    const std::vector<json> told = lines("m.jsonl");
    ASSERT_EQ(told.size(), 4U);
    EXPECT_EQ(told[1].at("id"), "E-CAM-VIEW");
    EXPECT_THAT(told[1].at("message"), HasSubstr("views.json#/views/1/eye: "));
    EXPECT_THAT(told[2].at("message"), HasSubstr("views.json#/views/2/camera: "));
    EXPECT_EQ(told[1].at("exit_code"), 64);
    EXPECT_TRUE(told[1].at("files").empty());
    EXPECT_EQ(told[3].at("id"), "OK");
    EXPECT_EQ(told[3].at("files")[0].at("file"), "b.exr");
    EXPECT_EQ(told[3].at("files")[0].at("bytes"), fs::file_size(folder_ / "b.exr"));
    EXPECT_EQ(told[3].at("files")[0].at("sha256").get<std::string>().size(), 64U);
}

TEST_F(ManyImages, FilesAreWrittenInTurnWhileTheNextImageIsRendered) {
    json scene = json::parse(text("quad.gltf"));
    scene["extensionsUsed"].push_back("EXT_unheard_of");
    folder_.write("quad.gltf", scene.dump());
    folder_.write("views.json", R"({"views": [
        {"name": "a", "azimuth": 10}, {"name": "b", "azimuth": 20, "width": 40, "height": 30},
        {"name": "c", "azimuth": 30}, {"name": "d", "azimuth": 40}]})");
    const auto told = [&](const std::string& threads) {
        const Texts files = {"--views", "views.json", "-o", "{view}.exr", "-o", "{view}.png"};
        const ProgramRun got =
            render("quad.gltf", joined(files, {"--threads", threads, "--manifest", "m.jsonl"}));
        expect_result(got, 0, "OK");
        for (const char* step : {"a is written, 1 of 4", "d is written, 4 of 4", "rendered 4 ima"})
            EXPECT_THAT(got.err, HasSubstr(step));
        const size_t warned = got.err.find("EXT_unheard_of");
        EXPECT_EQ(got.err.find("EXT_unheard_of", warned + 1), std::string::npos) << "shown once";
        std::vector<json> out = lines("m.jsonl");
        for (json& line : out)
            line.erase("seconds");
        return out;
    };
    const std::vector<json> one_by_one = told("1");
    ASSERT_EQ(one_by_one.size(), 4U);
    EXPECT_EQ(one_by_one[3].at("view"), "d");
    for (const json& line : one_by_one) {
        ASSERT_EQ(line.at("warnings").size(), 1U) << line;
        EXPECT_THAT(line.at("warnings")[0].dump(), HasSubstr("EXT_unheard_of"));
    }
    for (const char* name : {"a.exr", "b.png", "c.exr", "d.png"})
        fs::remove(folder_ / name);
    EXPECT_EQ(told("2"), one_by_one) << "with the same checksums";
}

TEST_F(ManyImages, AFileThatCannotBeWrittenFailsItsImageAlone) {
    folder_.write("views.json", R"({"views": [
        {"name": "a"}, {"name": "large", "width": 200, "height": 200}, {"name": "b"}]})");
    for (const char* threads : {"1", "2"}) {
        ProgramSetup limited = setup({"render",
                                      "quad.gltf",
                                      "--size",
                                      "8x8",
                                      "--spp",
                                      "1",
                                      "--float",
                                      "--write-retries",
                                      "0",
                                      "--views",
                                      "views.json",
                                      "-o",
                                      "{view}.exr",
                                      "--manifest",
                                      "m.jsonl",
                                      "--threads",
                                      threads},
                                     folder_);
        limited.before_start = [] {
            const rlimit limit = {30000, 30000};
            setrlimit(RLIMIT_FSIZE, &limit);
        };
        const ProgramRun got = run_program_with(limited);
        expect_result(got, 74, "E-OUT-WRITE");
        EXPECT_THAT(got.err, HasSubstr("1 of 3 images failed"));
        const std::vector<json> told = lines("m.jsonl");
        ASSERT_EQ(told.size(), 3U) << threads;
        EXPECT_EQ(told[0].at("id"), "OK");
        EXPECT_EQ(told[1].at("id"), "E-OUT-WRITE");
        EXPECT_EQ(told[2].at("id"), "OK");
        EXPECT_TRUE(fs::exists(folder_ / "b.exr") && !fs::exists(folder_ / "large.exr"));
    }
}

/// Points are as thick as each view says, so that their pose is made anew for each.
TEST_F(ManyImages, TakeTheMemoryOfOneImageWhereThereIsNoMore) {
    json scene = json::parse(text("quad.gltf"));
    scene["meshes"][0]["primitives"][0]["mode"] = 0;
    folder_.write("points.gltf", scene.dump());
    const auto turntable = [&](int mebibytes) {
        return render("points.gltf",
                      {"--turntable",
                       "3",
                       "--size",
                       "1000x1000",
                       "--spp",
                       "1",
                       "--threads",
                       "2",
                       "--max-memory",
                       std::to_string(mebibytes) + "M",
                       "--verbose",
                       "-o",
                       "{frame}.exr"});
    };
    constexpr int program_mebibytes = 160;
    const ProgramRun none = turntable(program_mebibytes + 8);
    expect_result(none, 33, "E-MEM");
    std::smatch found;
    ASSERT_TRUE(std::regex_search(none.err, found, std::regex("film would take ([0-9]+) MiB")));
    const int film_mebibytes = std::stoi(found[1]);
    ASSERT_GT(film_mebibytes, 20);
    const ProgramRun narrow = turntable(program_mebibytes + film_mebibytes + 10);
    expect_result(narrow, 0, "OK");
    EXPECT_THAT(narrow.err, HasSubstr("the image before is written first"));
    const ProgramRun wide = turntable(program_mebibytes + 2 * film_mebibytes + 10);
    EXPECT_THAT(wide.err, Not(HasSubstr("memory lacks")));
}

TEST_F(ManyImages, AViewWithIntrinsicsHasNoShift) {
    folder_.write("views.json", R"({"views": [{"name": "own", "azimuth": 3},
        {"name": "cv", "K": [[40, 0, 16], [0, 40, 8], [0, 0, 1]], "t": [0, 0, 4]}]})");
    const ProgramRun got =
        render("quad.gltf", {"--views", "views.json", "--shift", "0.1,0", "-o", "{view}.exr"});
    expect_result(got, 64, "E-USAGE-CONFLICT");
    EXPECT_THAT(got.err, HasSubstr("--shift"));
    EXPECT_TRUE(fs::exists(folder_ / "own.exr"));
    EXPECT_FALSE(fs::exists(folder_ / "cv.exr"));
}

TEST_F(ManyImages, WhatAllNeedEndsTheCommand) {
    folder_.write("views.json", R"({"views": [{"name": "a"}, {"name": "b"}]})");
    folder_.write("bad.hdr", "#?RADIANCE\nbroken");
    const Texts all = {"--views", "views.json", "-o", "{view}.exr"};
    expect_result(render("box.gltf", joined(all, {"--env", "bad.hdr"})), 67, "E-ENV-CORRUPT");
    expect_result(render("box.gltf", joined(all, {"--focus-node", "no"})), 64, "E-NODE-UNKNOWN");
    EXPECT_FALSE(fs::exists(folder_ / "a.exr") || fs::exists(folder_ / "b.exr"));
}

TEST_F(ManyImages, ViewsMayHaveVariantsOfTheirOwn) {
    folder_.write("views.json", R"({"views": [{"name": "no", "variant": "Green"}, {"name": "a"},
        {"name": "blue", "variant": "Blue/1"}]})");
    const Texts views = {"--views", "views.json"};
    const ProgramRun got =
        render("quad.gltf", joined(views, {"-o", "{view}.exr", "--manifest", "m.jsonl"}));
    expect_result(got, 64, "E-VARIANT-UNKNOWN");
    EXPECT_THAT(got.err, HasSubstr("1 of 3 images failed"));
    EXPECT_EQ(text("m.jsonl").find('\x1f'), std::string::npos);
    for (const json& line : lines("m.jsonl")) {
        if (line.at("view") != "no") continue;
        EXPECT_THAT(line.at("message").get<std::string>(),
                    HasSubstr("views.json#/views/0/variant: "));
    }
    const Texts both = {"--variants", "Red,Blue*", "-o", "{view}.{variant}.exr"};
    expect_result(render("quad.gltf", joined(views, both)), 64, "E-VARIANT-UNKNOWN");
    expect_same("a.Blue_1.exr", "blue.Blue_1.exr");
    expect_same("blue.exr", "blue.Blue_1.exr");
    EXPECT_TRUE(fs::exists(folder_ / "a.Red.exr"));
    EXPECT_FALSE(fs::exists(folder_ / "blue.Red.exr"));
}

TEST_F(ManyImages, ACamerasExposureIsItsOwn) {
    json scene = json::parse(gltf_text(box_scene()));
    scene["extensionsUsed"].push_back("OBSCURA_camera");
    scene["cameras"][0]["extensions"]["OBSCURA_camera"]["exposure"]["ev100"] = 4;
    folder_.write("dim.gltf", scene.dump());
    expect_result(render("dim.gltf", {"--cameras", "Front,Top", "-o", "{view}.png"}), 0, "OK");
    for (const char* name : {"Front", "Top"}) {
        expect_result(render("dim.gltf", {"--camera", name, "-o", "one.png"}), 0, "OK");
        expect_same(std::string(name) + ".png", "one.png");
    }
}

TEST_F(ManyImages, NamesThatBecomeEqualGetNumbers) {
    json scene = json::parse(gltf_text(box_scene()));
    scene["cameras"][0]["name"] = "a/b";
    scene["cameras"][1]["name"] = "a:b";
    for (json& node : scene["nodes"]) {
        if (node.contains("camera")) node.erase("name");
    }
    folder_.write("names.gltf", scene.dump());
    expect_result(render("names.gltf", {"--cameras", "a*", "-o", "{view}.exr"}), 0, "OK");
    EXPECT_TRUE(fs::exists(folder_ / "a_b.exr") && fs::exists(folder_ / "a_b-2.exr"));
}

TEST_F(ManyImages, AreSkippedDividedAndKeptByTheirViews) {
    const Texts turn = {"--turntable", "3", "--variants", "all", "-o", "{variant}.##.exr"};
    expect_result(render("quad.gltf", joined(turn, {"--part", "1/2"})), 0, "OK");
    EXPECT_EQ(fs::exists(folder_ / "Red.01.exr"), true);
    EXPECT_EQ(fs::exists(folder_ / "Red.02.exr"), false);
    const Texts rest = {"--skip-existing", "--manifest", "m.jsonl"};
    folder_.write("m.jsonl", "");
    const ProgramRun got = render("quad.gltf", joined(turn, rest));
    expect_result(got, 0, "OK");
    EXPECT_EQ(result_of(got)->skipped, 3);
    const std::vector<json> told = lines("m.jsonl");
    ASSERT_EQ(told.size(), 6U);
    EXPECT_EQ(told[0].at("was_there"), true);
    EXPECT_EQ(told[1].at("was_there"), false);
    const std::string kept = text("Red.02.exr");
    fs::remove(folder_ / "Red.02.exr");
    expect_result(render("quad.gltf",
                         joined(turn, {"--checkpoint=keep/{variant}.{frame}", "--skip-existing"})),
                  0,
                  "OK");
    EXPECT_TRUE(without_fingerprints(text("Red.02.exr")) == without_fingerprints(kept));
}

TEST_F(ManyImages, SequencesHaveViewsToo) {
    const Texts frames = {"--frames", "1-2", "--fps", "1"};
    folder_.write("views.json",
                  R"({"views": [{"name": "a", "azimuth": 0}, {"name": "b", "azimuth": 90}]})");
    const Texts all = {"--views", "views.json", "-o", "{view}.##.exr"};
    expect_result(render("box.gltf", joined(frames, all)), 0, "OK");
    expect_result(
        render("box.gltf", joined(frames, {"--azimuth", "90", "-o", "one.##.exr"})), 0, "OK");
    expect_same("b.01.exr", "one.01.exr");
    expect_same("b.02.exr", "one.02.exr");
}

TEST_F(ManyImages, SeveralScenesAreThoseOfSingleCommands) {
    fs::create_directories(folder_ / "other");
    fs::copy_file(folder_ / "box.gltf", folder_ / "other/quad.gltf");
    const auto render_all = [&](const Texts& scenes, const Texts& more) {
        const Texts small = {"render", "--size", "24x16", "--spp", "2"};
        return run(joined(joined(small, more), scenes));
    };
    // A manifest that is shared has its folder made, too.
    const Texts shared = {"--manifest", "new/m.jsonl", "--skip-existing", "-o", "new/{asset}.exr"};
    expect_result(render("box.gltf", shared), 0, "OK");
    EXPECT_EQ(lines("new/m.jsonl").size(), 1U);
    const Texts outputs = {"--manifest", "m.jsonl", "-o", "out/{asset}.exr"};
    const ProgramRun got = render_all({"quad.gltf", "none.gltf", "other/quad.gltf"}, outputs);
    expect_result(got, 66, "E-SCENE-MISSING");
    EXPECT_THAT(got.err, HasSubstr("1 of 3 renderings failed"));
    expect_result(render("quad.gltf", {"-o", "one.exr"}), 0, "OK");
    expect_same("out/quad.exr", "one.exr");
    expect_result(render("box.gltf", {"-o", "one.exr"}), 0, "OK");
    expect_same("out/quad-2.exr", "one.exr");
    EXPECT_EQ(lines("m.jsonl").size(), 3U);
    // Without a name the scenes tell it; other files are of one scene.
    const Texts two = {"box.gltf", "triangle.gltf"};
    expect_result(render_all(two, {"--turntable", "2"}), 0, "OK");
    EXPECT_TRUE(fs::exists(folder_ / "triangle.0002.exr") && fs::exists(folder_ / "box.0001.exr"));
    for (const Texts& more : {Texts{"-o", "a.exr"}, Texts{"-o", "-"}, Texts{"--stats", "s.json"}})
        expect_result(render_all(two, more), 64, "E-USAGE-CONFLICT");
}

TEST_F(ManyImages, AManifestReplacesNothingThatIsRead) {
    folder_.write("views.json", R"({"views": [{"azimuth": 3}]})");
    const std::string scene = text("box.gltf"), views = text("views.json");
    const Texts cameras = {"--cameras", "all", "-o", "{view}.exr", "--manifest"};
    expect_result(render("box.gltf", joined(cameras, {"box.gltf"})), 64, "E-USAGE-SAMEFILE");
    expect_result(render("box.gltf", joined(cameras, {"Front.exr"})), 64, "E-USAGE-CONFLICT");
    const Texts list = {"--views", "views.json", "-o", "{view}.exr", "--manifest", "views.json"};
    expect_result(render("box.gltf", list), 64, "E-USAGE-SAMEFILE");
    EXPECT_EQ(text("box.gltf"), scene);
    EXPECT_EQ(text("views.json"), views);
}

TEST_F(ManyImages, MistakesAreRefused) {
    const auto views = [&](const std::string& list) {
        folder_.write("views.json", "{\"views\": " + list + "}");
        return render("box.gltf", {"--views", "views.json", "-o", "{view}.exr"});
    };
    expect_result(views("[]"), 65, "E-VIEWS-VALUE");
    expect_result(views(R"([{"azimuth": "left"}])"), 65, "E-JSON-TYPE");
    expect_result(views(R"([{"azimut": 3}])"), 65, "E-VIEWS-KEY");
    expect_result(views(R"([{"time": 1}, {"azimuth": 3}])"), 65, "E-VIEWS-VALUE");
    expect_result(views(R"([{"width": 20.5, "height": 3}])"), 65, "E-JSON-TYPE");
    expect_result(views(R"([{"elevation": 91}])"), 65, "E-VIEWS-VALUE");
    expect_result(views(R"([{"azimuth": 3, "eye": [1, 2, 3]}])"), 65, "E-VIEWS-VALUE");
    expect_result(views(R"([{"R": [1, 0, 0, 0, 1, 0, 0, 0, 1]}])"), 65, "E-DOC-MISSING");
    expect_result(render("box.gltf", {"--views", "none.json"}), 67, "E-VIEWS-MISSING");
    expect_refused({"--cameras", "all", "-o", "a.exr"}, "E-USAGE-CONFLICT", "{view}");
    expect_refused({"--cameras", "all", "-o", "-"}, "E-USAGE-CONFLICT", "one image");
    expect_refused({"--variants", "all", "-o", "{view}.exr"}, "E-USAGE-SAMEFILE", "{variant}");
    EXPECT_FALSE(fs::exists(folder_ / "view.exr"));
}

}  // namespace
}  // namespace obscura
