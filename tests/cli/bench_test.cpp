// tests/cli/bench_test.cpp - obscura bench from outside: report, files, refusals.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include <nlohmann/json.hpp>

namespace obscura {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Bench : public Cli {
protected:
    ProgramRun bench(const std::vector<std::string>& more, const std::string& repeat = "2") const {
        std::vector<std::string> arguments = {
            "bench", "--size", "32x18", "--spp", "2", "--repeat", repeat};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    }
    json report(const std::string& name) const {
        return json::parse(read_whole_file(folder_ / name));
    }
    static void expect_spread(const json& spread) {
        EXPECT_LE(spread.at("low").get<double>(), spread.at("median").get<double>());
        EXPECT_LE(spread.at("median").get<double>(), spread.at("high").get<double>());
    }
    static void expect_view(const json& view) {
        for (const char* key : {"eye", "target", "up"})
            EXPECT_EQ(view.at("camera").at(key).size(), 3U) << key;
        EXPECT_GT(view.at("camera").at("fov_deg").get<double>(), 0);
        EXPECT_GE(view.at("coverage").get<double>(), 0);
        for (const char* key : {"render_s", "replay_s", "of_bare"})
            expect_spread(view.at(key));
        double shares = 0;
        for (const auto& stage : view.at("stages"))
            shares += stage.at("share").get<double>();
        EXPECT_NEAR(shares, 1, 1e-9);
        EXPECT_EQ(view.at("paths"), 32 * 18 * 2);
        for (const char* kind : {"camera", "bounce", "shadow"}) {
            const json& rays = view.at("rays").at(kind);
            EXPECT_GE(rays.at("count").get<int>(), rays.at("hits").get<int>()) << kind;
        }
        EXPECT_GT(view.at("paths_per_second").get<double>(), 0);
        EXPECT_GT(view.at("rays_per_second").get<double>(), 0);
    }
};

TEST_F(Bench, WritesAWholeReport) {
    const ProgramRun got = bench({"box.gltf", "--json", "b.json", "--threads", "1"});
    expect_result(got, 0, "OK");
    EXPECT_THAT(got.out, HasSubstr("of bare Embree"));
    const json whole = report("b.json");
    EXPECT_TRUE(whole.at("version").is_string());
    for (const char* key : {"cpu",
                            "cores",
                            "clock_mhz",
                            "caches",
                            "numa_nodes",
                            "load",
                            "embree",
                            "compiler",
                            "build_type"})
        EXPECT_TRUE(whole.at("machine").contains(key)) << key;
    EXPECT_EQ(whole.at("settings").at("width"), 32);
    ASSERT_EQ(whole.at("scenes").size(), 1U);
    const json& scene = whole.at("scenes").at(0);
    EXPECT_EQ(scene.at("name"), "box");
    EXPECT_EQ(scene.at("triangles"), 12);
    for (const char* key : {"load_s", "decode_s", "bvh_s", "bare_read_s", "of_bare"})
        expect_spread(scene.at("load").at(key));
    EXPECT_GT(scene.at("memory").at("bare").get<double>(), 0);
    EXPECT_GT(scene.at("memory").at("peak").get<double>(), 1e6);
    ASSERT_EQ(scene.at("views").size(), 2U);
    EXPECT_EQ(scene.at("views").at(0).at("name"), "whole");
    EXPECT_EQ(scene.at("views").at(1).at("name"), "close");
    EXPECT_GE(scene.at("views").at(1).at("coverage").get<double>(), 0.7);
    for (const json& view : scene.at("views"))
        expect_view(view);
    EXPECT_GT(whole.at("figures").size(), 10U);
    EXPECT_THAT(got.err, HasSubstr("too little to measure well"));
}

TEST_F(Bench, ComparesScalesAndDraws) {
    expect_result(bench({"quad.gltf", "--json", "old.json"}, "3"), 0, "OK");
    const ProgramRun got = bench({"quad.gltf",
                                  "--compare",
                                  "old.json",
                                  "--json",
                                  "new.json",
                                  "--threads",
                                  "1,2",
                                  "--isa",
                                  "all",
                                  "--plot",
                                  "p.svg",
                                  "--view",
                                  "whole"},
                                 "3");
    expect_result(got, 0, "OK");
    EXPECT_THAT(got.out, HasSubstr("scaling"));
    EXPECT_THAT(got.out, HasSubstr("verdict"));
    const json whole = report("new.json");
    const json& scene = whole.at("scenes").at(0);
    EXPECT_EQ(scene.at("views").size(), 1U);
    ASSERT_EQ(scene.at("by_threads").size(), 2U);
    EXPECT_EQ(scene.at("by_threads").at(0).at("threads"), 1);
    EXPECT_EQ(scene.at("by_threads").at(0).at("efficiency"), 1);
    EXPECT_EQ(scene.at("by_threads").at(1).at("threads"), 2);
    for (const json& change : whole.at("changes")) {
        EXPECT_THAT(change.at("verdict").get<std::string>(),
                    testing::AnyOf("faster", "slower", "within noise", "the same"));
    }
    EXPECT_GT(whole.at("changes").size(), 5U);
    EXPECT_THAT(read_whole_file(folder_ / "p.svg"), HasSubstr("</svg>"));
}

TEST_F(Bench, TakesEveryAssetOfAFolderAndAnOwnView) {
    std::filesystem::create_directory(folder_ / "set");
    std::filesystem::copy(folder_ / "box.gltf", folder_ / "set");
    std::filesystem::copy(folder_ / "triangle.gltf", folder_ / "set");
    expect_result(bench({"--assets", "set", "--json", "b.json", "--eye", "0,0,5"}), 0, "OK");
    const json whole = report("b.json");
    ASSERT_EQ(whole.at("scenes").size(), 2U);
    for (const json& scene : whole.at("scenes")) {
        ASSERT_EQ(scene.at("views").size(), 1U);
        EXPECT_EQ(scene.at("views").at(0).at("name"), "own");
        EXPECT_NEAR(scene.at("views").at(0).at("camera").at("eye").at(2).get<double>(), 5, 1e-6);
    }
}

TEST_F(Bench, GoesOnAfterASceneThatCannotBeUsed) {
    expect_result(bench({"missing.gltf", "box.gltf", "--json", "b.json"}), 66, "E-SCENE-MISSING");
    const json whole = report("b.json");
    ASSERT_EQ(whole.at("scenes").size(), 1U);
    EXPECT_EQ(whole.at("scenes").at(0).at("name"), "box");
    EXPECT_THAT(whole.at("warnings").dump(), HasSubstr("missing.gltf: left out"));
}

TEST_F(Bench, RefusesWhatMakesNoSense) {
    const auto refused = [&](const std::vector<std::string>& more, const std::string& id) {
        std::vector<std::string> arguments = {"box.gltf"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        SCOPED_TRACE(more[0]);
        expect_result(bench(arguments), 64, id);
    };
    refused({"--view", "far"}, "E-USAGE-CHOICE");
    refused({"--isa", "sse9"}, "E-USAGE-CHOICE");
    refused({"--threads", "1,x"}, "E-USAGE-NUMBER");
    refused({"--threads", "1,,2"}, "E-USAGE-NUMBER");
    refused({"--plot", "p.svg"}, "E-USAGE-CONFLICT");
    refused({"--view", "close", "--eye", "1,2,3"}, "E-USAGE-CONFLICT");
    refused({"--camera-model", "orthographic"}, "E-USAGE-CONFLICT");
    refused({"--assets", "."}, "E-USAGE-CONFLICT");
    refused({"--json", ""}, "E-USAGE-CONFLICT");
    refused({"--json", "box.gltf"}, "E-USAGE-SAMEFILE");
    refused({"--integrator", "magic"}, "E-USAGE-CHOICE");
    refused({"--integrator", "heat"}, "E-USAGE-CHOICE");
    refused({"--wrong"}, "E-USAGE");
    expect_result(run({"bench", "box.gltf", "--repeat", "0"}), 64, "E-USAGE-RANGE");
}

TEST_F(Bench, SaysWhatIsMissing) {
    expect_result(bench({"missing.gltf"}), 66, "E-SCENE-MISSING");
    expect_result(bench({"--assets", "missing"}), 67, "E-BENCH-ASSETS");
    expect_result(bench({"box.gltf", "--compare", "missing.json"}), 67, "E-BENCH-OLD");
    expect_result(bench({"box.gltf", "--json", "no/folder.json"}), 73, "E-OUT-CREATE");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "no"));
}

/// What it measures is tested in tests/bench/standard_test.cpp; here, what it refuses.
TEST_F(Bench, TheStandardIsFixed) {
    const auto refused = [&](std::vector<std::string> more, const std::string& named) {
        more.insert(more.begin(), {"bench", "--standard"});
        const ProgramRun got = run(more);
        expect_result(got, 64, "E-USAGE-CONFLICT");
        EXPECT_THAT(got.err, HasSubstr("where=" + named));
    };
    refused({"--spp", "8"}, "--spp");
    refused({"--repeat", "3"}, "--repeat");
    refused({"box.gltf"}, "SCENE");
    refused({"--threads", "1,2"}, "--threads");
    refused({"--plot", "p.svg"}, "--plot");
    folder_.write("old.json", R"({"figures": [], "circumstances": "other"})");
    const ProgramRun got = run({"bench", "--standard", "--compare", "old.json"});
    expect_result(got, 67, "E-BENCH-OLD");
    EXPECT_THAT(got.err, HasSubstr("it is of no standard"));
}

}  // namespace
}  // namespace obscura
