// tests/cli/explain_pixel_test.cpp - `obscura explain-pixel`: reports, files and refusals.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include "support/text_files.h"
#include "support/xml_text.h"
#include <nlohmann/json.hpp>

namespace obscura {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string lecture = OBSCURA_SOURCE_DIR "/assets/lecture/lecture.gltf";
const std::string analytic = OBSCURA_SOURCE_DIR "/assets/analytic/analytic.gltf";
const std::string instances = OBSCURA_SOURCE_DIR "/assets/instances/instances.glb";

class ExplainPixelCommand : public Cli {
protected:
    ProgramRun explain(std::vector<std::string> arguments) const {
        arguments.insert(arguments.begin(), "explain-pixel");
        return run(std::move(arguments));
    }
    json report(std::vector<std::string> arguments) const {
        arguments.emplace_back("--json");
        const ProgramRun got = explain(std::move(arguments));
        expect_result(got, 0, "OK");
        return json::parse(got.out);
    }
    void refused(std::vector<std::string> arguments,
                 const std::string& id,
                 const std::string& message,
                 int code = 64) const {
        const ProgramRun got = explain(std::move(arguments));
        expect_result(got, code, id);
        EXPECT_THAT(got.err, HasSubstr(message));
        EXPECT_EQ(got.out, "");
    }
};

/// Compared with the image of another run of the program, for pixels all over it.
TEST_F(ExplainPixelCommand, TheSumIsThePixelOfTheImage) {
    for (const std::string& scene : {lecture, analytic, instances}) {
        expect_result(run({"render",
                           scene,
                           "--integrator",
                           "raycast",
                           "--size",
                           "12x8",
                           "--float",
                           "-o",
                           "r.exr"}),
                      0,
                      "OK");
        const auto image = read_image_file(folder_ / "r.exr");
        ASSERT_TRUE(image);
        for (size_t i = 41; i < 96; i += scene == instances ? 60 : 17) {
            const std::string pixel = std::to_string(i % 12) + "," + std::to_string(i / 12);
            const json got = report({scene, pixel, "--size", "12x8"});
            for (size_t c = 0; c < 3; ++c) {
                const float expected = image->pixels[4 * i + c];
                EXPECT_EQ(got.at("rgba").at(c).get<float>(), expected) << scene << pixel;
            }
            EXPECT_TRUE(got.at("renderer").at("agrees").get<bool>()) << scene << pixel;
        }
    }
}

TEST_F(ExplainPixelCommand, TextNamesWhatIsSeenAndWhatIsInTheWay) {
    const ProgramRun got = explain({lecture, "2,0", "--size", "5x5", "--camera", "Plan"});
    expect_result(got, 0, "OK");
    EXPECT_THAT(got.out, HasSubstr("pixel (2, 0) of 5 x 5: lecture.gltf"));
    EXPECT_THAT(got.out, HasSubstr("seen: plane of node 0 'Floor'"));
    EXPECT_THAT(got.out, HasSubstr("in the shadow of sphere of node 2 'Ball'"));
    EXPECT_THAT(got.out, HasSubstr("pixel, the sum = (0, 0, 0), alpha 1"));
}

TEST_F(ExplainPixelCommand, DrawsThePixel) {
    expect_result(explain({lecture, "2,2", "--size", "5x5", "-o", "p.svg"}), 0, "OK");
    const std::string svg = read_text(folder_ / "p.svg");
    EXPECT_TRUE(test::is_well_formed(svg)) << svg;
    EXPECT_THAT(svg, HasSubstr("1  t = 4: sphere of node 2"));
}

TEST_F(ExplainPixelCommand, EveryCameraAndTheTimeOfTheScene) {
    const std::string motion = OBSCURA_SOURCE_DIR "/assets/motion/motion.glb";
    const auto seen = [&](const std::string& time) {
        return report({motion, "79,70", "--size", "160x90", "--time", time})
            .at("renderer")
            .at("name");
    };
    EXPECT_NE(seen("0"), seen("0.6"));  // the ball has left the floor
    const std::vector<std::vector<std::string>> cameras = {
        {"--camera-model", "orthographic"},
        {"--fstop", "2", "--focus-on", "80,45"},
        {"--fisheye", "stereographic", "--fov", "200"},
        {"--environment", "cylindrical"},
        {"--distortion", "-0.2,0.05,0,0"},
        {"--near", "1", "--far", "30"}};
    for (const std::vector<std::string>& camera : cameras) {
        std::vector<std::string> arguments = {lecture, "80,45", "--size", "160x90"};
        arguments.insert(arguments.end(), camera.begin(), camera.end());
        const json got = report(arguments);
        EXPECT_TRUE(got.at("renderer").at("agrees").get<bool>()) << camera.front();
        EXPECT_TRUE(got.at("renderer").at("hit").get<bool>()) << camera.front();
    }
}

TEST_F(ExplainPixelCommand, AnEmptyPlaceIsTheBackground) {
    const json got =
        report({"triangle.gltf", "0,0", "--size", "8x8", "--background", "0.25,0.5,1"});
    EXPECT_FALSE(got.at("renderer").at("hit").get<bool>());
    EXPECT_EQ(got.count("seen"), 0U);
    EXPECT_EQ(got.at("rgba"), json::array({0.25, 0.5, 1.0, 1.0}));
    EXPECT_EQ(got.at("objects").at(0).at("fate"), "missed");
}

TEST_F(ExplainPixelCommand, ObjectsAreListedUpToANumber) {
    const json got = report({"box.gltf", "4,4", "--size", "8x8", "--objects", "3"});
    EXPECT_EQ(got.at("objects").size(), 3U);
    const size_t others = got.at("more_near").get<size_t>() + got.at("elsewhere").get<size_t>();
    EXPECT_EQ(others, 9U);
    EXPECT_EQ(report({"box.gltf", "4,4", "--size", "8x8"}).at("objects").size(), 12U);
}

TEST_F(ExplainPixelCommand, RefusesWhatItCannotExplain) {
    refused({"triangle.gltf", "8,0", "--size", "8x4"},
            "E-USAGE-RANGE",
            "X from 0 to 7 and Y from 0 to 3");
    refused(
        {"triangle.gltf", "0,4", "--size", "8x4"}, "E-USAGE-RANGE", "outside the picture of 8x4");
    refused({"triangle.gltf", "1280,0"}, "E-USAGE-RANGE", "X from 0 to 1279 and Y from 0 to 719");
    refused({"triangle.gltf", "4"}, "E-USAGE-NUMBER", "expected X,Y in pixels");
    refused({"triangle.gltf", "4,x"}, "E-USAGE-NUMBER", "expected X,Y in pixels");
    refused({"triangle.gltf", "1.5,2"}, "E-USAGE-NUMBER", "expected X,Y in pixels");
    refused({"--", "triangle.gltf", "-1,2"}, "E-USAGE-RANGE", "X from 0 to 1279");
    refused({"triangle.gltf"}, "E-USAGE", "PIXEL");
    refused({"missing.gltf", "1,2"}, "E-SCENE-MISSING", "missing.gltf", 66);
    refused({"triangle.gltf", "1,2", "-o", "p.png"}, "E-OUT-FORMAT", "ends in .svg");
    refused({"triangle.gltf", "1,2", "-o", "no/p.svg"}, "E-OUT-CREATE", "no/p.svg", 73);
    refused({"triangle.gltf", "1,2", "--objects", "0"}, "E-USAGE-RANGE", "--objects");
    refused({"triangle.gltf", "1,2", "--shutter", "0,1"}, "E-USAGE-CONFLICT", "one ray");
    refused({"triangle.gltf", "1,2", "--camera", "Top"}, "E-CAM-UNKNOWN", "Top");
}

}  // namespace
}  // namespace obscura
