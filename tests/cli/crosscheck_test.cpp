// tests/cli/crosscheck_test.cpp - obscura crosscheck from outside: reports, files, exit codes.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include <nlohmann/json.hpp>

namespace obscura {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Crosscheck : public Cli {
protected:
    json report(const std::string& name) const {
        return json::parse(read_whole_file(folder_ / name));
    }
};

TEST_F(Crosscheck, WritesAReportAndAnImage) {
    const ProgramRun got = run({"crosscheck",
                                "box.gltf",
                                "--rays",
                                "32k",
                                "--size",
                                "64x36",
                                "--json",
                                "c.json",
                                "--image",
                                "c.png"});
    expect_result(got, 0, "OK");
    EXPECT_THAT(got.out, HasSubstr("within the budget"));
    const json whole = report("c.json");
    const json& scene = whole.at("scenes").at(0);
    EXPECT_EQ(scene.at("triangles"), 12);
    EXPECT_EQ(scene.at("rays"), 32000);
    EXPECT_TRUE(scene.at("within_budget").get<bool>());
    EXPECT_EQ(scene.at("truth").at("wrong"), 0);
    EXPECT_EQ(scene.at("formulas").at("wrong"), 0);
    for (const json& pair : scene.at("pairs")) {
        uint64_t sum = 0;
        for (const char* key :
             {"agree", "equal_depth", "edge", "crack", "edge_on", "depth", "missed", "false_hit"})
            sum += pair.at(key).get<uint64_t>();
        EXPECT_EQ(sum, 32000U) << pair.at("kernel");
    }
    const auto image = read_image_file(folder_ / "c.png");
    ASSERT_TRUE(image.has_value());
    EXPECT_EQ(image->width, 64);
}

TEST_F(Crosscheck, ReplaysARay) {
    const ProgramRun got = run({"crosscheck", "box.gltf", "--ray", "0.1,0.2,9,0,0,-1"});
    expect_result(got, 0, "OK");
    EXPECT_THAT(got.out, HasSubstr("double precision"));
    EXPECT_THAT(got.out, HasSubstr("robust 16"));
}

TEST_F(Crosscheck, ChecksTheProjectsOwnShapes) {
    const std::string scene = std::string(OBSCURA_SOURCE_DIR) + "/assets/analytic/analytic.gltf";
    const ProgramRun got = run({"crosscheck", scene, "--rays", "100k"});
    expect_result(got, 0, "OK");
    EXPECT_THAT(got.out, HasSubstr("sphere points 16"));
}

TEST_F(Crosscheck, GoesOnAfterASceneThatCannotBeUsed) {
    const ProgramRun got = run({"crosscheck", "none.gltf", "box.gltf", "--rays", "10k"});
    expect_result(got, 66, "E-SCENE-MISSING");
    EXPECT_THAT(got.out, HasSubstr("within the budget"));
}

TEST_F(Crosscheck, RefusesWhatMakesNoSense) {
    expect_result(run({"crosscheck", "box.gltf", "--rays", "ten"}), 64, "E-USAGE-NUMBER");
    expect_result(run({"crosscheck", "box.gltf", "--ray", "1,2"}), 64, "E-USAGE-NUMBER");
    expect_result(run({"crosscheck", "none.gltf"}), 66, "E-SCENE-MISSING");
    expect_result(run({"crosscheck", "box.gltf", "--json", "no/folder.json"}), 73, "E-OUT-CREATE");
}

}  // namespace
}  // namespace obscura
