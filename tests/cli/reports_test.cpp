// tests/cli/reports_test.cpp - progress lines, statistics, info, and what --quiet leaves.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include <nlohmann/json.hpp>

namespace obscura {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Reports : public Cli {};

TEST_F(Reports, ProgressLinesOnStandardOutput) {
    const ProgramRun got = run({"render", "box.gltf", "--size", "400x300", "--spp", "64"});
    const std::vector<std::string> lines = lines_of(got.out);
    ASSERT_GE(lines.size(), 2U);
    EXPECT_EQ(lines.front(), "Progress: 0%");
    EXPECT_EQ(lines.back(), "Progress: 100%");
    int last = -1;
    for (const std::string& line : lines) {
        std::smatch match;
        ASSERT_TRUE(std::regex_match(line, match, std::regex(R"(Progress: (\d+)%)"))) << line;
        EXPECT_GE(std::stoi(match[1]), last);
        last = std::stoi(match[1]);
    }
}

TEST_F(Reports, QuietIsSilentButForErrors) {
    const ProgramRun good = render("triangle.gltf", {"--quiet", "-o", "a.exr", "-o", "a.png"});
    EXPECT_EQ(good.code, 0);
    EXPECT_EQ(good.out, "");
    EXPECT_EQ(good.err, "");
    const ProgramRun bad = render("missing.gltf", {"--quiet"});
    EXPECT_EQ(bad.out, "");
    expect_result(bad, 66, "E-SCENE-MISSING");
    EXPECT_EQ(lines_of(bad.err).size(), 2U);
    EXPECT_EQ(run({"info", "--quiet", "box.gltf"}).err, "");
}

TEST_F(Reports, AFarmManagerIsToldInItsOwnWords) {
    const ProgramRun good = render("triangle.gltf", {"--quiet", "--farm", "openjd"});
    EXPECT_EQ(good.code, 0) << good.err;
    EXPECT_THAT(good.out, HasSubstr("openjd_progress: 0\n"));
    EXPECT_THAT(good.out, testing::EndsWith("Progress: 100%\nopenjd_progress: 100\n"));
    const ProgramRun bad = render("missing.gltf", {"--farm", "openjd"});
    expect_result(bad, 66, "E-SCENE-MISSING");
    EXPECT_THAT(bad.out, HasSubstr("openjd_fail: missing.gltf: "));
    EXPECT_THAT(render("missing.gltf", {"--farm", "alf"}).out,
                testing::Not(HasSubstr("openjd_fail")));
}

TEST_F(Reports, ASceneWithoutLightSaysThatItGetsAStudio) {
    EXPECT_THAT(render("triangle.gltf").err, HasSubstr("studio"));
    EXPECT_THAT(render("quad.gltf").err, testing::Not(HasSubstr("studio")));
}

TEST_F(Reports, StatisticsAreCompleteAndTrue) {
    expect_result(
        render("box.gltf", {"--stats", "s.json", "--seed", "9", "--threads", "1"}), 0, "OK");
    const json stats = json::parse(read_whole_file(folder_ / "s.json"));
    EXPECT_EQ(stats.at("scene"), "box.gltf");
    EXPECT_EQ(stats.at("outputs"), json::array({"box.exr"}));
    EXPECT_EQ(stats.at("width"), 24);
    EXPECT_EQ(stats.at("height"), 16);
    EXPECT_EQ(stats.at("spp"), 2);
    EXPECT_EQ(stats.at("seed"), 9);
    EXPECT_EQ(stats.at("depth"), 8);
    EXPECT_EQ(stats.at("integrator"), "path");
    EXPECT_EQ(stats.at("threads"), 1);
    EXPECT_TRUE(stats.at("version").is_string());
    EXPECT_TRUE(stats.at("isa").is_string());
    EXPECT_TRUE(stats.at("embree").is_string());
    double sum = 0;
    for (const char* phase : {"load_s", "build_s", "render_s", "write_s"}) {
        EXPECT_GE(stats.at("phases").at(phase).get<double>(), 0) << phase;
        sum += stats.at("phases").at(phase).get<double>();
    }
    EXPECT_LE(sum, stats.at("phases").at("total_s").get<double>());
    EXPECT_LE(stats.at("phases").at("parse_s").get<double>() +
                  stats.at("phases").at("decode_s").get<double>(),
              stats.at("phases").at("load_s").get<double>() + 1e-3);
    const json& rays = stats.at("rays");
    EXPECT_EQ(rays.at("camera"), 24 * 16 * 2);
    EXPECT_EQ(stats.at("paths"), 24 * 16 * 2);
    EXPECT_EQ(
        rays.at("total").get<int>(),
        rays.at("camera").get<int>() + rays.at("bounce").get<int>() + rays.at("shadow").get<int>());
    for (const char* stage : {"camera_s", "intersect_s", "shade_s", "shadow_s", "accumulate_s"})
        EXPECT_GE(stats.at("stages").at(stage).get<double>(), 0) << stage;
    EXPECT_GT(stats.at("rays_per_second").get<double>(), 0);
    EXPECT_GT(stats.at("paths_per_second").get<double>(), 0);
    EXPECT_GT(stats.at("peak_memory_bytes").get<double>(), 1e6);
    EXPECT_GT(stats.at("memory").at("bvh").get<int>(), 0);
    EXPECT_GT(stats.at("memory").at("geometry").get<int>(), 0);
    EXPECT_EQ(stats.at("memory").at("textures"), 0);
    EXPECT_EQ(stats.at("memory").at("film"), 24 * 16 * 4 * 4);
    EXPECT_EQ(stats.at("counters").at("refused_rays"), 0);
    EXPECT_EQ(stats.at("counters").at("nonfinite_samples"), 0);
    EXPECT_TRUE(stats.at("warnings").empty());
}

TEST_F(Reports, WarningsAreCountedAndKept) {
    SmallScene scene = box_scene();
    scene.more += R"(, "extensionsUsed": ["VENDOR_materials_glow"])";
    scene.material += R"(, "extensions": {"VENDOR_materials_glow": {}})";
    folder_.write("wax.gltf", gltf_text(scene));
    const ProgramRun got = render("wax.gltf", {"--stats", "s.json"});
    EXPECT_THAT(got.err, HasSubstr("WARN "));
    EXPECT_THAT(got.err, HasSubstr("VENDOR_materials_glow"));
    ASSERT_TRUE(result_of(got));
    EXPECT_EQ(result_of(got)->warnings, 1) << got.err;
    const json stats = json::parse(read_whole_file(folder_ / "s.json"));
    EXPECT_THAT(stats.at("warnings").at(0).get<std::string>(), HasSubstr("VENDOR_materials_glow"));
}

TEST_F(Reports, InfoAsJson) {
    const ProgramRun got = run({"info", "box.gltf", "--json"});
    expect_result(got, 0, "OK");
    const json info = json::parse(got.out);
    EXPECT_EQ(info.at("file"), "box.gltf");
    EXPECT_EQ(info.at("gltf_version"), "2.0");
    EXPECT_EQ(info.at("generator"), "obscura tests");
    EXPECT_EQ(info.at("copyright"), "CC0");
    EXPECT_EQ(info.at("scenes"), json::array({"Main"}));
    EXPECT_EQ(info.at("nodes").size(), 5U);
    EXPECT_EQ(
        info.at("nodes").at(0),
        json(
            {{"id_node", 1}, {"path", "/node 0"}, {"mesh", "Mesh"}, {"instances", json::array()}}));
    EXPECT_EQ(info.at("meshes").at(0).at("triangles"), 12);
    EXPECT_EQ(info.at("triangles_in_file"), 12);
    EXPECT_EQ(info.at("triangles_in_world"), 12);
    EXPECT_EQ(info.at("instances"), 0);
    EXPECT_EQ(info.at("texture_memory_bytes"), 0);
    EXPECT_THAT(info.at("materials").dump(), HasSubstr("Paint"));
    ASSERT_EQ(info.at("cameras").size(), 4U);
    const json& front = info.at("cameras").at(0);
    EXPECT_EQ(front.at("name"), "Front");
    EXPECT_EQ(front.at("type"), "perspective");
    EXPECT_NEAR(front.at("yfov_rad").get<double>(), 0.6, 1e-6);
    EXPECT_TRUE(front.at("aspect").is_null());
    EXPECT_EQ(front.at("world_from_camera").size(), 16U);
    EXPECT_NEAR(front.at("world_from_camera").at(11).get<double>(), 6, 1e-6);
    EXPECT_NEAR(front.at("camera_from_world").at(11).get<double>(), -6, 1e-6);
    EXPECT_EQ(info.at("cameras").at(1).at("type"), "orthographic");
    EXPECT_NEAR(info.at("bounds").at("high_m").at(0).get<double>(), 1, 1e-6);

    const json lit = json::parse(run({"info", "quad.gltf", "--json"}).out);
    EXPECT_EQ(lit.at("lights").at(0).at("type"), "directional");
    EXPECT_EQ(lit.at("lights").at(0).at("unit"), "lux");
    EXPECT_EQ(lit.at("extensions").at(0).at("name"), "KHR_lights_punctual");
    EXPECT_EQ(lit.at("extensions").at(0).at("supported"), true);
}

TEST_F(Reports, InfoAsATable) {
    const std::string table = run({"info", "quad.gltf"}).out;
    for (const char* text : {"quad.gltf",
                             "'Main' (shown)",
                             "'Mesh': 2 triangles",
                             "2 in the file, 2 in the world",
                             "'Paint'",
                             "directional, 3.14159 3.14159 3.14159 lux",
                             "'Front': perspective, yfov 45.8366 deg",
                             "KHR_lights_punctual: supported"}) {
        EXPECT_THAT(table, HasSubstr(text));
    }
}

TEST_F(Reports, TheLocaleDoesNotMatter) {
    const auto with_locale = [&](const std::string& locale, const std::string& name) {
        ProgramSetup german = setup(small_render("quad.gltf",
                                                 {"--exposure",
                                                  "0.5",
                                                  "--background",
                                                  "0.25,0.5,1",
                                                  "-o",
                                                  name,
                                                  "--stats",
                                                  name + ".json"}),
                                    folder_);
        german.environment = {"OCIO=", "LC_ALL=" + locale, "LANG=" + locale};
        expect_result(run_program_with(german), 0, "OK");
        EXPECT_TRUE(json::accept(read_whole_file(folder_ / (name + ".json")))) << locale;
        return read_whole_file(folder_ / name);
    };
    EXPECT_EQ(with_locale("C", "c.png"), with_locale("de_DE.UTF-8", "de.png"));
}

}  // namespace
}  // namespace obscura
