// tests/serve/job_check_test.cpp - a client's job names no file but the server's.
// SPDX-License-Identifier: Apache-2.0
#include "serve/job_check.h"

#include <gtest/gtest.h>

#include "serve/option_names.h"

namespace obscura::serve {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// A server that has a.glb, b.glb, sky.hdr and one upload.
JobFiles small_server() {
    JobFiles files;
    files.find = [](const std::string& name) -> Result<fs::path> {
        if (name == "a.glb" || name == "b.glb" || name == "sky.hdr") return "/roots/" + name;
        if (name == "upload:12/up.glb") return fs::path("/uploads/12/up.glb");
        if (name == "out.glb") return fail(ExitCode::refused, "E-URI-REFUSED", name, "leads out");
        return fail(ExitCode::missing_scene, "E-SCENE-MISSING", name, "not found");
    };
    files.match = [](const std::string& pattern) -> std::vector<std::string> {
        if (pattern == "*.glb") return {"a.glb", "b.glb"};
        if (pattern == "o*.glb") return {"out.glb"};
        if (pattern == "many*") return std::vector<std::string>(2001, "a.glb");
        return {};
    };
    files.options = [find = files.find](const Options& given) -> Result<Options> {
        Options out = given;
        if (!out.contains("env") || out["env"] == "studio") return out;
        const auto file = find(out["env"].get<std::string>());
        if (!file) return fail(file.error());
        out["env"] = file->string();
        return out;
    };
    return files;
}

Result<CheckedJob> check(const char* text, const Options& common = Options::object()) {
    return check_job(json::parse(text), small_server(), common);
}

/// "ID place" of the error, or "OK".
std::string fault_of(const char* text) {
    const auto checked = check(text);
    return checked ? "OK" : checked.error().id + " " + checked.error().where;
}

TEST(JobCheck, AssetsBecomeFilesThatWereFound) {
    const auto checked = check(R"({"assets": ["b.glb",
        {"files": "*.glb", "options": {"spp": 4, "env": "sky.hdr"}}, "upload:12/up.glb"]})");
    ASSERT_TRUE(checked) << checked.error().message;
    EXPECT_EQ(checked->job["assets"], json::parse(R"([{"files": "/roots/b.glb"},
        {"files": "/roots/a.glb", "options": {"spp": 4, "env": "/roots/sky.hdr"}},
        {"files": "/roots/b.glb", "options": {"spp": 4, "env": "/roots/sky.hdr"}},
        {"files": "/uploads/12/up.glb"}])"));
    EXPECT_EQ(checked->asset_of, (std::vector<size_t>{0, 1, 1, 2}));
    EXPECT_EQ(checked->manifest, "manifest.jsonl");
}

TEST(JobCheck, WhatIsPlainStaysAsItIs) {
    const auto checked = check(R"({"assets": ["a.glb"], "comment": "x",
        "options": {"size": "8x8", "cameras": "all"},
        "looks": ["day", {"name": "night", "options": {"env": "studio"}}],
        "outputs": ["o/{asset}.png", {"file": "s.webp", "options": {"spp": 1}}],
        "contact_sheet": "o/index.html"})",
                               {{"ocio", "/etc/c.ocio"}, {"size", "1x1"}});
    ASSERT_TRUE(checked) << checked.error().message;
    EXPECT_EQ(checked->job, json::parse(R"({"assets": [{"files": "/roots/a.glb"}],
        "options": {"size": "8x8", "cameras": "all", "ocio": "/etc/c.ocio"},
        "looks": [{"name": "day"}, {"name": "night", "options": {"env": "studio"}}],
        "outputs": ["o/{asset}.png", {"file": "s.webp", "options": {"spp": 1}}],
        "manifest": "o/index.jsonl", "contact_sheet": "o/index.html"})"));
}

TEST(JobCheck, AssetsStayBelowTheRoots) {
    EXPECT_EQ(fault_of(R"({"assets": ["a.glb", "../a.glb"]})"), "E-URI-REFUSED /assets/1/files");
    EXPECT_EQ(fault_of(R"({"assets": ["x/../*.glb"]})"), "E-URI-REFUSED /assets/0/files");
    EXPECT_EQ(fault_of(R"({"assets": ["/roots/a.glb"]})"), "E-URI-REFUSED /assets/0/files");
    EXPECT_EQ(fault_of(R"({"assets": ["a.glb\u0000"]})"), "E-URI-REFUSED /assets/0/files");
    EXPECT_EQ(fault_of(R"({"assets": [""]})"), "E-URI-REFUSED /assets/0/files");
    EXPECT_EQ(fault_of(R"({"assets": ["o*.glb"]})"), "E-URI-REFUSED /assets/0/files");
    EXPECT_EQ(fault_of(R"({"assets": ["c.glb"]})"), "E-SCENE-MISSING /assets/0/files");
    EXPECT_EQ(fault_of(R"({"assets": ["c*.glb"]})"), "E-JOB-ASSETS /assets/0/files");
    EXPECT_EQ(fault_of(R"({"assets": ["upload:13/*.glb"]})"), "E-SCENE-MISSING /assets/0/files");
    EXPECT_EQ(fault_of(R"({"assets": ["many*"]})"), "E-JOB-LIMIT /assets/0");
}

TEST(JobCheck, WhatIsWrittenStaysInTheJobsFolder) {
    for (const std::string name :
         {"/tmp/x.png", "../x.png", "a/../../x.png", "", "-", "a\\u0000"}) {
        const std::string job = R"({"assets": ["a.glb"], )";
        EXPECT_EQ(fault_of((job + R"("outputs": ["ok.png", ")" + name + "\"]}").c_str()),
                  "E-JOB-PATH /outputs/1");
        EXPECT_EQ(fault_of((job + R"("outputs": [{"file": ")" + name + "\"}]}").c_str()),
                  "E-JOB-PATH /outputs/0");
        EXPECT_EQ(fault_of((job + R"("manifest": ")" + name + "\"}").c_str()),
                  "E-JOB-PATH /manifest");
        EXPECT_EQ(fault_of((job + R"("contact_sheet": ")" + name + "\"}").c_str()),
                  "E-JOB-PATH /contact_sheet");
    }
}

TEST(JobCheck, OptionsNameNoFiles) {
    for (const char* const name : {"ocio",
                                   "views",
                                   "camera-json",
                                   "aperture",
                                   "stats",
                                   "output",
                                   "segmentation",
                                   "checkpoint",
                                   "crypto-manifest",
                                   "manifest",
                                   "texture-cache",
                                   "config",
                                   "threads",
                                   "max-memory",
                                   "a/b~"}) {
        EXPECT_FALSE(is_job_option(name)) << name;
        const json options = {{name, "/etc/passwd"}};
        const std::string pointer = std::string(name) == "a/b~" ? "a~1b~0" : name;
        for (const char* const list : {"looks", "outputs"}) {
            json job = {{"assets", {"a.glb"}}};
            const char* const key = std::string(list) == "looks" ? "name" : "file";
            job[list] = {{{key, "x"}, {"options", options}}};
            EXPECT_EQ(fault_of(job.dump().c_str()),
                      "E-JOB-KEY /" + std::string(list) + "/0/options/" + pointer);
        }
        const json whole = {{"assets", {"a.glb"}}, {"options", options}};
        EXPECT_EQ(fault_of(whole.dump().c_str()), "E-JOB-KEY /options/" + pointer);
        const json asset = {{"assets", {{{"files", "a.glb"}, {"options", options}}}}};
        EXPECT_EQ(fault_of(asset.dump().c_str()), "E-JOB-KEY /assets/0/options/" + pointer);
    }
}

TEST(JobCheck, AnEnvironmentIsFoundOrBuiltIn) {
    EXPECT_EQ(fault_of(R"({"assets": ["a.glb"], "options": {"env": "/etc/passwd"}})"),
              "E-SCENE-MISSING /options/env");
    EXPECT_EQ(fault_of(R"({"assets": ["a.glb"], "options": {"env": ["/etc/passwd"]}})"),
              "E-JOB-VALUE /options/env");
    EXPECT_EQ(fault_of(R"({"assets": ["a.glb"], "looks": [{"options": {"env": 1}}]})"),
              "E-JOB-VALUE /looks/0/options/env");
}

TEST(JobCheck, TheFormIsThatOfBatch) {
    EXPECT_EQ(fault_of(R"({})"), "E-DOC-MISSING ");
    EXPECT_EQ(fault_of(R"({"assets": []})"), "E-JOB-VALUE /assets");
    EXPECT_EQ(fault_of(R"({"assets": "a.glb"})"), "E-JOB-VALUE /assets");
    EXPECT_EQ(fault_of(R"({"assets": [3]})"), "E-JOB-VALUE /assets/0");
    EXPECT_EQ(fault_of(R"({"assets": [{}]})"), "E-DOC-MISSING /assets/0");
    EXPECT_EQ(fault_of(R"({"assets": [{"files": 3}]})"), "E-JOB-VALUE /assets/0/files");
    EXPECT_EQ(fault_of(R"({"assets": ["a.glb"], "assetz": 1})"), "E-JOB-KEY /assetz");
    EXPECT_EQ(fault_of(R"({"assets": ["a.glb"], "outputs": [{}]})"), "E-DOC-MISSING /outputs/0");
    EXPECT_EQ(fault_of(R"({"assets": ["a.glb"], "looks": [{"neme": "x"}]})"),
              "E-JOB-KEY /looks/0/neme");
    EXPECT_EQ(fault_of(R"({"assets": ["a.glb"], "options": []})"), "E-JOB-VALUE /options");
    EXPECT_EQ(fault_of(R"({"assets": ["a.glb"], "manifest": 3})"), "E-JOB-VALUE /manifest");
}

TEST(JobCheck, ErrorsHaveTheClientsNames) {
    const auto checked = check(R"({"assets": ["*.glb", "upload:12/up.glb"],
        "options": {"variants": "x"}, "looks": ["a", {"name": "b", "options": {"fps": 1}}]})");
    ASSERT_TRUE(checked);
    const auto place = [&](const std::string& where) {
        return client_error(*checked, {ExitCode::usage, "E-X", where, ""}).where;
    };
    EXPECT_EQ(place("../job.json#/looks/0/options/spp"), "/looks/0/options/spp");
    EXPECT_EQ(place("../job.json#/assets/1/options/spp"), "/assets/0/options/spp");
    EXPECT_EQ(place("../job.json#/assets/2"), "/assets/1");
    EXPECT_EQ(place("../job.json"), "job");
    EXPECT_EQ(place("/uploads/12/up.glb#/meshes/0"), "upload:12/up.glb#/meshes/0");
    EXPECT_EQ(place("--variants"), "/options/variants");
    EXPECT_EQ(place("--fps"), "/looks/1/options/fps");
    EXPECT_EQ(place("--scene"), "--scene");
    EXPECT_EQ(client_text(*checked, "see /roots/a.glb"), "see a.glb");
}

}  // namespace
}  // namespace obscura::serve
