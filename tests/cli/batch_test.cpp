// tests/cli/batch_test.cpp - obscura batch: jobs of assets, looks and outputs.
// SPDX-License-Identifier: Apache-2.0
#include "base/work_lock.h"

#include "cli/cli.h"
#include "support/text_files.h"
#include <map>
#include <nlohmann/json.hpp>

namespace obscura {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using Texts = std::vector<std::string>;

class Batch : public Cli {
protected:
    void SetUp() override {
        Cli::SetUp();
        fs::create_directories(folder_ / "in");
        for (const char* name : {"box.gltf", "quad.gltf", "triangle.gltf"})
            fs::rename(folder_ / name, folder_ / "in" / name);
    }
    ProgramRun batch(const json& job, const Texts& more = {}) const {
        folder_.write("job.json", job.dump());
        return run(joined({"batch", "job.json"}, more));
    }
    static json small_job() {
        return json::parse(R"({
            "assets": ["in/[bq]*.gltf"],
            "options": {"size": "24x16", "spp": 2},
            "looks": [{"name": "day", "options": {"env": "sky:40,30"}},
                      {"name": "studio", "options": {"env": "studio", "exposure": 0.5}}],
            "outputs": ["out/{asset}/{look}.png",
                        {"file": "out/{asset}/{look}_small.exr", "options": {"size": "12x8"}}],
            "manifest": "out.jsonl"})");
    }
    void expect_same(const std::string& one, const std::string& other) const {
        const auto a = read_image_file(folder_ / one);
        const auto b = read_image_file(folder_ / other);
        ASSERT_TRUE(a && b) << one << ", " << other;
        EXPECT_TRUE(a->pixels == b->pixels) << one << ", " << other;
    }
    std::vector<json> lines(const std::string& manifest) const {
        std::vector<json> out;
        for (const std::string& line : split_lines(read_text(folder_ / manifest)))
            out.push_back(json::parse(line));
        return out;
    }
    /// The file names that a dry run prints.
    Texts files_of(const json& job, const Texts& more = {}) const {
        const ProgramRun got = batch(job, joined({"--dry-run"}, more));
        EXPECT_EQ(got.code, 0) << got.err;
        return split_lines(got.out);
    }
};

TEST_F(Batch, ImagesAreThoseOfSingleCommands) {
    expect_result(batch(small_job()), 0, "OK");
    const Texts day = {"--env", "sky:40,30", "-o"};
    const Texts studio = {"--env", "studio", "--exposure", "0.5", "-o"};
    expect_result(render("in/box.gltf", joined(day, {"one.png"})), 0, "OK");
    expect_same("out/box/day.png", "one.png");
    expect_result(render("in/quad.gltf", joined(studio, {"one.png"})), 0, "OK");
    expect_same("out/quad/studio.png", "one.png");
    expect_result(
        render("in/quad.gltf", joined({"--size", "12x8"}, joined(day, {"one.exr"}))), 0, "OK");
    expect_same("out/quad/day_small.exr", "one.exr");
    EXPECT_FALSE(fs::exists(folder_ / "out/triangle"));
    const std::vector<json> told = lines("out.jsonl");
    ASSERT_EQ(told.size(), 8U);
    EXPECT_EQ(told[0].at("look"), "day");
    EXPECT_EQ(told[7].at("asset"), "in/quad.gltf");
}

TEST_F(Batch, LooksMayDifferInTheirEnvironmentAlone) {
    json job = small_job();
    job["assets"] = {"in/quad.gltf"};
    job["outputs"] = {"{look}.exr"};
    expect_result(batch(job), 0, "OK");
    const Texts studio = {"--env", "studio", "--exposure", "0.5", "-o", "one.exr"};
    expect_result(render("in/quad.gltf", studio), 0, "OK");
    expect_same("studio.exr", "one.exr");
}

TEST_F(Batch, ADryRunNamesTheFilesOfEachPart) {
    const Texts all = files_of(small_job());
    EXPECT_EQ(all.size(), 8U);
    EXPECT_EQ(all.front(), "out/box/day.png");
    EXPECT_FALSE(fs::exists(folder_ / "out") || fs::exists(folder_ / "out.jsonl"));
    EXPECT_THAT(files_of(small_job(), {"--part", "2/2"}), testing::Each(HasSubstr("quad")));
    json turns = small_job();
    turns["assets"] = {"in/box.gltf"};
    turns["looks"] = {{{"name", "a"}}};
    turns["outputs"] = {"{frame}.png"};
    turns["options"]["turntable"] = 4;
    EXPECT_EQ(files_of(turns).size(), 4U);
    turns.erase("manifest");
    expect_result(batch(turns, {"--part", "2/3"}), 0, "OK");
    EXPECT_TRUE(fs::exists(folder_ / "2.png"));
    EXPECT_FALSE(fs::exists(folder_ / "1.png") || fs::exists(folder_ / "3.png"));
}

TEST_F(Batch, FinishedImagesAreLeft) {
    json job = small_job();
    job["contact_sheet"] = "sheet/index.html";
    expect_result(batch(job), 0, "OK");
    fs::remove(folder_ / "out/box/day.png");
    const ProgramRun again = batch(job, {"--skip-existing"});
    expect_result(again, 0, "OK");
    EXPECT_EQ(result_of(again)->skipped, 7);
    EXPECT_TRUE(fs::exists(folder_ / "out/box/day.png"));
    const std::string page = read_text(folder_ / "sheet/index.html");
    EXPECT_THAT(page, HasSubstr("src=\"../out/box/day.png\""));
    EXPECT_THAT(page, HasSubstr("<h2>in/quad.gltf</h2>"));
}

TEST_F(Batch, OptionsThatNoRenderingUsesAreToldOf) {
    json job = small_job();
    job["options"]["quality"] = 80;  // for JPEG alone
    job["options"]["compression"] = "zip";
    job["looks"][0]["options"]["integrator"] = "normal";
    job["looks"][0]["options"]["regularize"] = true;
    job["looks"][1]["options"]["regularize"] = true;
    const ProgramRun got = batch(job, {"--dry-run"});
    expect_result(got, 0, "OK");
    EXPECT_EQ(result_of(got)->warnings, 2);
    EXPECT_THAT(got.err, HasSubstr("WARN job.json#/options/quality: it changes nothing here"));
    EXPECT_THAT(got.err, HasSubstr("WARN job.json#/looks/0/options/regularize: it changes"));
}

TEST_F(Batch, WhatOthersHoldIsLeftToThem) {
    json job = small_job();
    job["looks"] = {"a"};
    job["outputs"] = {"out/{asset}.exr"};
    fs::create_directories(folder_ / "out");
    folder_.write("out/box.exr.lock", lock_text({"elsewhere", "", 7, "long ago"}));
    const ProgramRun got = batch(job, {"--skip-existing"});
    expect_result(got, 75, "E-LOCKED");
    EXPECT_TRUE(fs::exists(folder_ / "out/quad.exr")) << "the rest is rendered";
    EXPECT_FALSE(fs::exists(folder_ / "out/box.exr"));
}

TEST_F(Batch, PartsShareTheirManifest) {
    json job = small_job();
    job["looks"] = {"a"};
    job["outputs"] = {"out/{asset}.png"};
    job["contact_sheet"] = "new/index.html";
    expect_result(batch(job, {"--part", "2/2"}), 0, "OK");
    expect_result(batch(job, {"--part", "1/2"}), 0, "OK");
    EXPECT_EQ(lines("out.jsonl").size(), 2U);
    for (int i = 0; i < 2; ++i)
        expect_result(batch(job, {"--skip-existing"}), 0, "OK");
    const std::string page = read_text(folder_ / "new/index.html");
    size_t figures = 0;
    for (size_t at = page.find("<figure>"); at != std::string::npos;
         at = page.find("<figure>", at + 1))
        ++figures;
    EXPECT_EQ(figures, 2U) << page;
    expect_result(batch(job), 0, "OK");
    EXPECT_EQ(lines("out.jsonl").size(), 2U) << "it begins anew";
}

TEST_F(Batch, FoldersOfItsFilesAreMade) {
    json job = small_job();
    job["assets"] = {"in/box.gltf"};
    job["looks"] = {"a"};
    job["outputs"] = {"pictures/box/a.png"};
    job["manifest"] = "notes/out.jsonl";
    expect_result(batch(job), 0, "OK");
    EXPECT_TRUE(fs::exists(folder_ / "pictures/box/a.png"));
    EXPECT_TRUE(fs::exists(folder_ / "notes/out.jsonl"));
}

TEST_F(Batch, FilesAreOfOneRendering) {
    json job = small_job();
    job["assets"] = {"in/box.gltf"};
    job["looks"] = {"a"};
    job["options"]["camera-json"] = "none.json";
    job["outputs"] = {"a.png"};
    expect_result(batch(job), 67, "E-CAMJSON-MISSING");
    ASSERT_EQ(lines("out.jsonl").size(), 1U);
    EXPECT_EQ(lines("out.jsonl")[0].at("id"), "E-CAMJSON-MISSING");
    job["options"].erase("camera-json");
    job["outputs"].push_back({{"file", "./a.png"}, {"options", {{"size", "12x8"}}}});
    expect_result(batch(job), 64, "E-USAGE-SAMEFILE");
}

TEST_F(Batch, WhatIsReadIsNeverReplaced) {
    json job = small_job();
    job["looks"] = {"a"};
    job["outputs"] = {"out/{asset}.png"};
    const std::string scene = read_text(folder_ / "in/box.gltf");
    job["manifest"] = "job.json";
    expect_result(batch(job), 64, "E-USAGE-SAMEFILE");
    EXPECT_EQ(read_text(folder_ / "job.json"), job.dump());
    job["manifest"] = "in/../in/box.gltf";
    expect_result(batch(job), 64, "E-USAGE-SAMEFILE");
    job["manifest"] = "out.jsonl";
    job["contact_sheet"] = "in/box.gltf";
    expect_result(batch(job), 64, "E-USAGE-SAMEFILE");
    EXPECT_EQ(read_text(folder_ / "in/box.gltf"), scene);
}

TEST_F(Batch, AnAutomaticExposureIsOneForALookOrAGroup) {
    json job = small_job();
    job["options"]["exposure"] = "auto";
    job["looks"] = json::parse(R"([{"name": "dim", "options": {"env-intensity": 0.25}},
                                   {"name": "bright", "options": {"env-intensity": 4}}])");
    job["options"]["env"] = "white";
    job["options"]["lights"] = "off";
    job["outputs"] = {"{asset}_{look}.png"};
    const auto exposures = [&] {
        std::map<std::string, double> out;
        for (const json& line : lines("out.jsonl")) {
            const auto [at, is_new] = out.emplace(line.at("look"), line.at("exposure"));
            EXPECT_EQ(at->second, line.at("exposure")) << "one for all assets of a look";
        }
        return out;
    };
    expect_result(batch(job), 0, "OK");
    ASSERT_EQ(lines("out.jsonl").size(), 4U);
    const std::map<std::string, double> of_looks = exposures();
    EXPECT_NEAR(of_looks.at("dim"), 4 + of_looks.at("bright"), 0.011) << "a sixteenth of the light";
    const std::string dim = json(of_looks.at("dim")).dump();
    const Texts dim_look = {"--env", "white", "--lights", "off", "--env-intensity", "0.25"};
    const Texts exposed = {"--exposure", dim, "-o", "one.png"};
    expect_result(render("in/quad.gltf", joined(dim_look, exposed)), 0, "OK");
    expect_same("quad_dim.png", "one.png");
    // It is the same to parts, to finished images, and in another order.
    const ProgramRun again = batch(job, {"--skip-existing", "--part", "2/2"});
    expect_result(again, 0, "OK");
    EXPECT_EQ(result_of(again)->skipped, 2);
    job["assets"] = {"in/quad.gltf", "in/box.gltf"};
    expect_result(batch(job, {"--threads", "1"}), 0, "OK");
    EXPECT_EQ(exposures(), of_looks);
    job["options"]["exposure"] = "auto:all";
    expect_result(batch(job), 0, "OK");
    EXPECT_EQ(exposures().at("dim"), exposures().at("bright"));
}

TEST_F(Batch, AnAssetIsReadOnceAndTheNextOneAhead) {
    const auto count = [](const std::string& text, const std::string& part) {
        size_t out = 0;
        for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
            ++out;
        return out;
    };
    json job = small_job();
    json scene = json::parse(read_text(folder_ / "in/quad.gltf"));
    scene["extensionsUsed"].push_back("EXT_unheard_of");
    folder_.write("in/quad.gltf", scene.dump());
    const ProgramRun alone = batch(job, {"--verbose", "--threads", "1"});
    expect_result(alone, 0, "OK");
    EXPECT_EQ(count(alone.err, "is open already"), 6U) << alone.err;
    EXPECT_EQ(count(alone.err, "was read ahead"), 0U);
    EXPECT_EQ(count(alone.err, "sky:40,30 is there already"), 3U) << "of four renderings";
    EXPECT_EQ(count(alone.err, "studio is there already"), 3U);
    const std::string small = read_text(folder_ / "out/quad/day_small.exr");
    const ProgramRun ahead = batch(job, {"--verbose", "--threads", "2"});
    expect_result(ahead, 0, "OK");
    EXPECT_EQ(count(ahead.err, "is open already"), 6U);
    EXPECT_EQ(count(ahead.err, "in/quad.gltf was read ahead"), 1U);
    EXPECT_EQ(count(ahead.err, "EXT_unheard_of"), 1U) << "it is shown once";
    EXPECT_EQ(read_text(folder_ / "out/quad/day_small.exr"), small);
    for (const json& line : lines("out.jsonl")) {
        const bool warns = line.at("warnings").dump().find("EXT_unheard_of") != std::string::npos;
        EXPECT_EQ(warns, line.at("asset") == "in/quad.gltf") << line;
    }
    // Metering has read them.
    job["options"]["exposure"] = "auto";
    for (json& look : job["looks"])
        look["options"].erase("exposure");
    const ProgramRun metered = batch(job, {"--verbose", "--threads", "2"});
    expect_result(metered, 0, "OK");
    EXPECT_EQ(count(metered.err, "is open already"), 8U) << metered.err;
    EXPECT_EQ(count(metered.err, "EXT_unheard_of"), 1U);
    // Where others may render what follows, nothing is read for it.
    const ProgramRun shared = batch(job, {"--verbose", "--threads", "2", "--skip-existing"});
    EXPECT_EQ(count(shared.err, "was read ahead"), 0U);
}

TEST_F(Batch, AnEnvironmentIsReadOnceForAllAssets) {
    const std::string file = (folder_ / "sky.exr").string();
    const std::vector<float> half_negative = {1, 1, 1, -1, -1, -1};
    const auto output = OIIO::ImageOutput::create(file);
    ASSERT_TRUE(output->open(file, OIIO::ImageSpec(2, 1, 3)) &&
                output->write_image(OIIO::TypeFloat, half_negative.data()) && output->close());
    json job = small_job();
    job["options"]["env"] = "sky.exr";
    job["looks"] = {"a", {{"name", "b"}, {"options", {{"exposure", 1}}}}};
    for (const char* exposure : {"0", "auto"}) {
        job["options"]["exposure"] = exposure;
        const ProgramRun got = batch(job);
        expect_result(got, 0, "OK");
        const size_t warned = got.err.find("values are negative");
        EXPECT_NE(warned, std::string::npos);
        EXPECT_EQ(got.err.find("values are negative", warned + 1), std::string::npos) << got.err;
        for (const json& line : lines("out.jsonl"))
            EXPECT_THAT(line.at("warnings").dump(), HasSubstr("values are negative"));
    }
}

TEST_F(Batch, WhatCannotBeMeteredIsLeftOut) {
    folder_.write("in/broken.gltf", "{");
    json job = small_job();
    job["options"]["exposure"] = "auto";
    job["looks"] = {"a"};
    job["outputs"] = {"{asset}.png"};
    expect_result(batch(job), 65, "E-JSON-SYNTAX");
    EXPECT_EQ(lines("out.jsonl").size(), 3U);
    job["assets"] = {"in/broken.gltf"};
    const ProgramRun got = batch(job);
    expect_result(got, 65, "E-JSON-SYNTAX");
    EXPECT_THAT(got.err, HasSubstr("shows nothing that can be metered"));
    job["options"]["exposure"] = "auto:";
    expect_result(batch(job), 64, "E-USAGE-NUMBER");
}

TEST_F(Batch, OneFailureDoesNotEndTheRest) {
    folder_.write("in/broken.gltf", "{");
    json job = small_job();
    job["looks"] = {{{"name", "<b>&\""}}};
    job["outputs"] = {"out/{asset}.png"};
    job["contact_sheet"] = "index.html";
    const ProgramRun got = batch(job);
    expect_result(got, 65, "E-JSON-SYNTAX");
    EXPECT_THAT(got.err, HasSubstr("1 of 3 renderings failed"));
    EXPECT_TRUE(fs::exists(folder_ / "out/box.png") && fs::exists(folder_ / "out/quad.png"));
    const std::string page = read_text(folder_ / "index.html");
    EXPECT_THAT(page, HasSubstr("&lt;b&gt;&amp;&quot;"));
    EXPECT_THAT(page, Not(HasSubstr("<b>")));
}

TEST_F(Batch, AMaskIsNoImageOfTheContactSheet) {
    json job = small_job();
    job["looks"] = {"a"};
    job["contact_sheet"] = "index.html";
    job["outputs"] = json::parse(R"([{"file": "out/{asset}.exr",
                                      "options": {"segmentation": "out/{asset}_seg.png"}}])");
    expect_result(batch(job), 0, "OK");
    EXPECT_TRUE(fs::exists(folder_ / "out/box_seg.png"));
    std::string page = read_text(folder_ / "index.html");
    EXPECT_THAT(page, HasSubstr("no file that a browser shows"));
    EXPECT_THAT(page, Not(HasSubstr("_seg.png")));
    for (const json& file : lines("out.jsonl")[0].at("files")) {
        const bool is_mask = file.at("file").get<std::string>().ends_with(".png");
        EXPECT_EQ(file.value("mask", false), is_mask) << file;
    }
    job["outputs"][0]["file"] = "out/{asset}.png";
    expect_result(batch(job), 0, "OK");
    page = read_text(folder_ / "index.html");
    EXPECT_THAT(page, HasSubstr("src=\"out/box.png\""));
    EXPECT_THAT(page, Not(HasSubstr("_seg.png")));
}

TEST_F(Batch, MistakesHaveTheirPlace) {
    const auto refused = [&](const char* patch, int code, const char* id, const char* place) {
        json job = small_job();
        job.merge_patch(json::parse(patch));
        const ProgramRun got = batch(job);
        expect_result(got, code, id);
        EXPECT_THAT(got.err, HasSubstr(place)) << patch;
        EXPECT_FALSE(fs::exists(folder_ / "out"));
    };
    refused(R"({"asset": []})", 65, "E-JOB-KEY", "job.json#/asset");
    refused(R"({"assets": null})", 65, "E-DOC-MISSING", "assets");
    refused(R"({"assets": []})", 65, "E-JOB-VALUE", "job.json#/assets");
    refused(
        R"({"assets": ["none/*.glb"]})", 66, "E-JOB-ASSETS", "job.json#/assets/0: 'none/*.glb'");
    refused(R"({"options": {"sp": 3}})", 65, "E-JOB-KEY", "job.json#/options/sp");
    refused(R"({"options": {"output": "a.png"}})", 65, "E-JOB-KEY", "job.json#/options/output");
    refused(R"({"options": {"spp": {}}})", 65, "E-JOB-VALUE", "job.json#/options/spp");
    refused(R"({"options": {"float": 1}})", 65, "E-JOB-VALUE", "job.json#/options/float");
    refused(R"({"looks": [{"options": {"spp": 0}}]})",
            64,
            "E-USAGE-RANGE",
            "job.json#/looks/0/options/spp");
    refused(R"({"outputs": ["out/{asset}.png"]})", 64, "E-USAGE-CONFLICT", "{look}");
    refused(R"({"outputs": [{"file": "a.png", "size": 3}]})",
            65,
            "E-JOB-KEY",
            "job.json#/outputs/0/size");
    refused(R"({"outputs": [{"options": {}}]})", 65, "E-DOC-MISSING", "job.json#/outputs/0");
    refused(R"({"outputs": ["out/a.png", "out/b.xyz"]})",
            64,
            "E-OUT-FORMAT",
            "job.json#/outputs/1: out/b.xyz: '.xyz' is not a format");
    refused(R"({"outputs": [{"file": "out/a.png"}], "options": {"frames": "1-3"}})",
            64,
            "E-USAGE-CONFLICT",
            "job.json#/outputs/0: out/a.png: with --frames a file's name must");
    refused(R"({"outputs": ["a.png", 3]})",
            65,
            "E-JSON-TYPE",
            "job.json#/outputs/1: this is 3; it must be a string or an object");
    refused(R"({"assets": [["in/box.gltf"]]})",
            65,
            "E-JSON-TYPE",
            "job.json#/assets/0: this is an array; it must be a string or an object");
    refused(R"({"contact_sheet": "a.png"})", 65, "E-JOB-VALUE", "job.json#/contact_sheet");
    refused(R"({"contact_sheet": "out.jsonl"})", 65, "E-JOB-VALUE", "job.json#/contact_sheet");
    expect_result(run({"batch", "none.json"}), 67, "E-JOB-MISSING");
}

TEST_F(Batch, UnknownOptionsAreAnsweredWithThoseNearToThem) {
    json job = small_job();
    job["options"]["varients"] = "all";
    EXPECT_THAT(batch(job).err, HasSubstr("(did you mean 'variants'"));
    job["options"].erase("varients");
    job["options"]["skip-existing"] = true;
    EXPECT_THAT(batch(job).err, Not(HasSubstr("did you mean")));
}

TEST_F(Batch, ADryRunTellsOfFilesThatTwoRenderingsHave) {
    json job = small_job();
    job["outputs"][1]["file"] = "out/./{asset}/{look}.png";
    const ProgramRun got = batch(job, {"--dry-run"});
    expect_result(got, 64, "E-USAGE-SAMEFILE");
    EXPECT_THAT(got.err, HasSubstr("another image of this command has this file"));
}

TEST_F(Batch, ACheckTellsEveryImageThatWouldFailAndWritesNothing) {
    json job = small_job();
    job["contact_sheet"] = "sheet/index.html";
    job["manifest"] = "told/out.jsonl";
    const ProgramRun good = batch(job, {"--check"});
    expect_result(good, 0, "OK");
    EXPECT_THAT(good.err, HasSubstr("in/quad.gltf is checked: nothing forbids to render it"));
    folder_.write("views.json", R"({"views": [{"name": "a", "azimuth": 10},
        {"name": "b", "variant": "red"}, {"name": "c", "camera": "nobody's"}]})");
    job["options"]["views"] = "views.json";
    job["outputs"] = {"out/{asset}/{look}/{view}.png"};
    const ProgramRun bad = batch(job, {"--check"});
    expect_result(bad, 64, "E-CAM-UNKNOWN");  // pictures of one variant are together
    EXPECT_THAT(bad.err, HasSubstr("ERROR views.json#/views/2/camera: 4 of 4 renderings failed"));
    EXPECT_THAT(bad.err, HasSubstr("ERROR views.json#/views/1/variant: red, b: the asset has no"));
    job["assets"] = {"in/quad.gltf"};
    job["looks"] = {"a"};
    expect_result(batch(job, {"--check", "--part", "1/3"}), 0, "OK");  // the first image alone
    for (const char* name : {"out", "sheet", "told"})
        EXPECT_FALSE(fs::exists(folder_ / name)) << name;
    expect_result(batch(job, {"--check", "--dry-run"}), 64, "E-USAGE-CONFLICT");
}

/// Folders that a job makes need not be there; those that it could not make do.
TEST_F(Batch, ACheckTellsOfFoldersThatCannotBeMade) {
    json job = small_job();
    folder_.write("out", "a file");
    expect_result(batch(job, {"--check"}), 73, "E-OUT-CREATE");
    job["outputs"] = {"fine/{asset}_{look}.png"};
    fs::create_directories(folder_ / "box_day.png");  // where the folder will be, not in it
    expect_result(batch(job, {"--check"}), 0, "OK");
    // Of an output by name alone `render` makes no folder.
    expect_result(render("in/box.gltf", {"--check", "-o", "a/{asset}.png", "-o", "b/c.png"}),
                  73,
                  "E-OUT-CREATE");
    EXPECT_FALSE(fs::exists(folder_ / "fine"));
}

/// Also what only the asset tells, or a file that is read in its turn.
TEST_F(Batch, MistakesThatShowLaterHaveTheirPlace) {
    const auto fails = [&](const char* patch, int code, const char* id, const char* message) {
        json job = small_job();
        job.merge_patch(json::parse(patch));
        const ProgramRun got = batch(job);
        expect_result(got, code, id);
        EXPECT_THAT(got.err, HasSubstr(message)) << patch;
    };
    fails(R"({"options": {"hide": ["Nobody"]}})",
          64,
          "E-HIDE-UNKNOWN",
          "job.json#/options/hide: no node, mesh or material is called 'Nobody'");
    fails(R"({"looks": [{"name": "x", "options": {"variant": "None"}}]})",
          64,
          "E-VARIANT-UNKNOWN",
          "job.json#/looks/0/options/variant: the asset has no variant");
    fails(R"({"looks": [{"name": "x", "options": {"env": "none.hdr"}}]})",
          67,
          "E-ENV-MISSING",
          "job.json#/looks/0/options/env: none.hdr: the environment cannot be read");
    fails(R"({"options": {"view": "None"}})",
          78,
          "E-OCIO-VIEW",
          "job.json#/options/view: None: display");
}

}  // namespace
}  // namespace obscura
