// tests/cli/camera_files_test.cpp - cameras from OBSCURA_camera and from --camera-json.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include <nlohmann/json.hpp>

namespace obscura {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using Strings = std::vector<std::string>;

class CameraFiles : public Cli {
protected:
    ReadImage shot(const std::string& scene, const Strings& options) const {
        Strings all = {"-o", "a.exr", "--float", "--threads", "2"};
        all.insert(all.end(), options.begin(), options.end());
        expect_result(render(scene, all), 0, "OK");
        auto image = read_image_file(folder_ / "a.exr");
        EXPECT_TRUE(image);
        return image.value_or(ReadImage{});
    }
    /// The box, its first camera with the extension's object.
    void write_box_with(const std::string& extension) const {
        SmallScene scene = box_scene();
        const std::string after = R"("name": "Front", )";
        scene.more.insert(scene.more.find(after) + after.size(),
                          R"("extensions": {"OBSCURA_camera": )" + extension + "}, ");
        scene.more += R"(, "extensionsUsed": ["OBSCURA_camera"])";
        folder_.write("own.gltf", gltf_text(scene));
    }
    void expect_bad_extension(const std::string& extension,
                              const std::string& id,
                              const std::string& where) {
        SCOPED_TRACE(extension);
        write_box_with(extension);
        const ProgramRun got = render("own.gltf");
        expect_result(got, 65, id);
        EXPECT_THAT(got.err, HasSubstr("own.gltf#/cameras/0/extensions/OBSCURA_camera" + where));
    }
    void expect_bad_json(json camera, const json& patch, const std::string& id) {
        camera.merge_patch(patch);
        SCOPED_TRACE(camera.dump());
        folder_.write("c.json", camera.dump());
        expect_result(render("box.gltf", {"--camera-json", "c.json"}), 65, id);
    }
};

TEST_F(CameraFiles, TheExtensionIsTheOptions) {
    const auto same = [&](const std::string& extension, const Strings& options) {
        SCOPED_TRACE(extension);
        write_box_with(extension);
        const ReadImage by_file = shot("own.gltf", {});
        const ReadImage by_options = shot("box.gltf", options);
        EXPECT_EQ(by_file.pixels, by_options.pixels);
        EXPECT_EQ(by_file.spec.get_string_attribute("obscura:cameraParameters"),
                  by_options.spec.get_string_attribute("obscura:cameraParameters"));
    };
    same(R"({"lens": {"radius": 0.2, "focusDistance": 5, "blades": 5, "anamorphic": 2}})",
         {"--lens-radius", "0.2", "--focus-distance", "5", "--blades", "5", "--anamorphic", "2"});
    same(R"({"focalLength": 0.05, "sensor": [0.036, 0.024], "lens": {"fstop": 1.4}})",
         {"--focal-length", "50", "--sensor", "36x24", "--fstop", "1.4"});
    same(R"({"fisheye": {"projection": "equisolid", "fov": 3.490658503988659}})",
         {"--fisheye", "equisolid", "--fov", "200"});
    same(R"({"model": "fisheye", "fisheye": {"coefficients": [-0.02, 0.004, 0, 0]}})",
         {"--fisheye-coefficients", "-0.02,0.004,0,0"});
    same(R"({"environment": {"projection": "latlong", "stereo": 0.06, "align": "view"}})",
         {"--stereo", "0.06", "--align", "view"});
    same(R"({"shift": [0.1, 0.2], "distortion": [0.1, 0, 0, 0.01, 0], "near": 5.2, "far": 6})",
         {"--shift", "0.1,0.2", "--distortion", "0.1,0,0,0.01", "--near", "5.2", "--far", "6"});
}

TEST_F(CameraFiles, OptionsOverrideTheExtensionOneByOne) {
    write_box_with(R"({"lens": {"radius": 0.2, "focusDistance": 5}})");
    const ReadImage image = shot("own.gltf", {"--focus-distance", "7"});
    const std::string parameters(image.spec.get_string_attribute("obscura:cameraParameters"));
    EXPECT_THAT(parameters, HasSubstr("lens_radius_m=0.2"));
    EXPECT_THAT(parameters, HasSubstr("focus_distance_m=7"));
    EXPECT_EQ(shot("own.gltf", {"--camera-model", "pinhole"}).pixels, shot("box.gltf", {}).pixels);
}

TEST_F(CameraFiles, InfoTellsTheModelAndTheMatrices) {
    write_box_with(R"({"lens": {"fstop": 2.8}, "focalLength": 0.05})");
    const ProgramRun table = run({"info", "own.gltf"});
    EXPECT_THAT(table.out, HasSubstr("model thinlens focal_length_mm=50 fstop=2.8"));
    EXPECT_THAT(table.out, HasSubstr("OBSCURA_camera: supported"));
    const json info = json::parse(run({"info", "own.gltf", "--json"}).out);
    const json& front = info.at("cameras").at(0);
    EXPECT_EQ(front.at("model"), "thinlens");
    EXPECT_EQ(front.at("settings").at("fstop"), "2.8");
    EXPECT_EQ(front.at("camera_from_world").at(11), -6);
    const json& top = info.at("cameras").at(1);
    EXPECT_EQ(top.at("model"), "orthographic");
    EXPECT_NEAR(top.at("ndc_from_world").at(0).get<double>(), 0.25, 1e-6) << "4 m are the width";
    EXPECT_FALSE(front.contains("ndc_from_world")) << "its aspect ratio is the picture's";
}

TEST_F(CameraFiles, FaultsOfTheExtensionArePointedAt) {
    expect_bad_extension(R"({"lense": {}})", "E-CAM-KEY", "/lense");
    expect_bad_extension(R"({"lens": {"fstop": 2, "focus": 1}})", "E-CAM-KEY", "/lens/focus");
    expect_bad_extension(R"({"lens": {"fstop": 0}})", "E-CAM-VALUE", "/lens/fstop");
    expect_bad_extension(R"({"lens": {"fstop": "2"}})", "E-JSON-TYPE", "/lens/fstop");
    expect_bad_extension(R"({"lens": {"fstop": 2, "blades": 2}})", "E-CAM-VALUE", "/lens/blades");
    expect_bad_extension(R"({"model": "thinlens"})", "E-CAM-VALUE", "/lens");
    expect_bad_extension(R"({"model": "round"})", "E-CAM-VALUE", "/model");
    expect_bad_extension(R"({"fisheye": {"fov": 7}})", "E-CAM-VALUE", "/fisheye/fov");
    expect_bad_extension(R"({"near": 2, "far": 1})", "E-CAM-VALUE", "/far");
    expect_bad_extension(R"({"distortion": [1, 2]})", "E-JSON-TYPE", "/distortion");
    expect_bad_extension(R"(7)", "E-JSON-TYPE", "");
}

/// A camera of 60x40 pixels 6 m before the box, like "Front", in the form of computer vision.
json vision_camera() {
    return {{"width", 60},
            {"height", 40},
            {"fx", 70.0},
            {"fy", 70.0},
            {"cx", 30.0},
            {"cy", 20.0},
            {"R", {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}},
            {"t", {0, 0, 6}}};
}

TEST_F(CameraFiles, IntrinsicsAndExtrinsicsMakeTheSameImageAsOurs) {
    folder_.write("c.json", vision_camera().dump());
    const ReadImage vision = shot("box.gltf", {"--camera-json", "c.json", "--size", "60x40"});
    const std::string fov = std::to_string(2 * std::atan(20 / 70.0) * 180 / 3.14159265358979);
    const Strings ours = {"--eye", "0,0,6", "--target", "0,0,0", "--fov", fov, "--size", "60x40"};
    const ReadImage same = shot("box.gltf", ours);
    for (size_t i = 0; i < vision.pixels.size(); ++i)
        EXPECT_NEAR(vision.pixels[i], same.pixels[i], 0.3f) << i;
    const ReadImage depth =
        shot("box.gltf", {"--camera-json", "c.json", "--size", "60x40", "--integrator", "depth"});
    EXPECT_NEAR(depth.pixels[20 * 60 + 30], 5, 1e-5);
    // Without --size the image has the file's.
    const ProgramRun got = run({"render",
                                "box.gltf",
                                "--camera-json",
                                "c.json",
                                "--spp",
                                "1",
                                "-o",
                                "a.exr",
                                "--threads",
                                "2"});
    expect_result(got, 0, "OK");
    EXPECT_EQ(read_image_file(folder_ / "a.exr")->width, 60);
    const Strings part = {"render", "box.gltf", "--camera-json", "c.json", "--crop", "50,0,11,9"};
    expect_result(run(part), 64, "E-USAGE-CONFLICT");
}

/// The edge of the box at x = 1, z = 1 appears where OpenCV's formula puts it.
TEST_F(CameraFiles, PointsLandOnOpenCvsPixels) {
    json camera = vision_camera();
    camera["cx"] = 22.5;
    camera["distortion"] = {0.2, 0.05, 0, 0, 0};
    folder_.write("c.json", camera.dump());
    const ReadImage depth =
        shot("box.gltf", {"--camera-json", "c.json", "--size", "600x400", "--integrator", "depth"});
    int edge = 0;
    while (edge < 600 && depth.pixels[static_cast<size_t>(200 * 600 + edge)] == 0)
        ++edge;
    while (edge < 600 && depth.pixels[static_cast<size_t>(200 * 600 + edge)] > 0)
        ++edge;
    const double x = 1 / 5.0;  // the nearest face is 5 m away
    const double expected = 70 * x * (1 + 0.2 * x * x + 0.05 * x * x * x * x) + 22.5;
    EXPECT_NEAR(edge, 10 * expected, 1.0);
}

TEST_F(CameraFiles, PoseAndPixelsMayBeWrittenInOtherWays) {
    const Strings options = {"--camera-json", "c.json", "--size", "60x40"};
    folder_.write("c.json", vision_camera().dump());
    const std::vector<float> wanted = shot("box.gltf", options).pixels;
    json k = vision_camera();
    for (const char* key : {"fx", "fy", "cx", "cy", "R", "t"})
        k.erase(key);
    k["K"] = {{70, 0, 29.5}, {0, 70, 19.5}, {0, 0, 1}};
    k["pixel_center"] = 0;
    k["world_to_camera"] = {{1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, -1, 6}, {0, 0, 0, 1}};
    folder_.write("c.json", k.dump());
    EXPECT_EQ(shot("box.gltf", options).pixels, wanted);
    k.erase("world_to_camera");
    k["camera_to_world"] = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 6};
    folder_.write("c.json", k.dump());
    EXPECT_EQ(shot("box.gltf", options).pixels, wanted);
    json fisheye = vision_camera();
    fisheye["model"] = "fisheye";
    fisheye["distortion"] = {0.01, 0.001, 0, 0};
    folder_.write("c.json", fisheye.dump());
    EXPECT_EQ(shot("box.gltf", options).spec.get_string_attribute("obscura:projection"), "fisheye");
}

TEST_F(CameraFiles, WhatIntrinsicsSayNoOptionSaysAgain) {
    const auto with = [&](const Strings& options) {
        return render("box.gltf", joined({"--camera-json", "c.json"}, options));
    };
    const auto refused = [&](const Strings& options) {
        const ProgramRun got = with(options);
        expect_result(got, 64, "E-USAGE-CONFLICT");
        EXPECT_THAT(got.err, HasSubstr("ERROR " + options.front() + ": a camera given by fx"));
    };
    folder_.write("c.json", vision_camera().dump());
    refused({"--shift", "0.1,0"});
    refused({"--focal-length", "50"});
    refused({"--sensor", "36x24", "--focal-length", "50"});
    refused({"--sensor", "36x24", "--focal-length", "50", "--fstop", "2"});
    refused({"--focal-length", "50", "--lens-radius", "0.1"});
    // The opening is of the focal length, and --fov takes the place of the intrinsics.
    expect_result(with({"--focal-length", "50", "--fstop", "2"}), 0, "OK");
    expect_result(with({"--sensor", "36x24", "--fstop", "2"}), 0, "OK");
    expect_result(with({"--fov", "40", "--shift", "0.1,0"}), 0, "OK");
    json fisheye = vision_camera();
    fisheye["model"] = "fisheye";
    folder_.write("c.json", fisheye.dump());
    refused({"--shift", "0.1,0"});
    refused({"--fisheye-fit", "diagonal"});
}

TEST_F(CameraFiles, FaultsOfTheJsonAreNamed) {
    const json good = vision_camera();
    expect_bad_json(good, {{"focal", 3}}, "E-CAM-KEY");
    expect_bad_json(good, {{"fx", 0}}, "E-CAM-VALUE");
    expect_bad_json(good, {{"fx", nullptr}}, "E-DOC-MISSING");
    expect_bad_json(good, {{"width", 0.5}}, "E-JSON-TYPE");
    expect_bad_json(good, {{"R", {1, 0, 0, 0, 1, 0, 0, 0, 2}}}, "E-CAM-MATRIX");
    expect_bad_json(good, {{"R", {1, 0, 0}}}, "E-CAM-VALUE");
    expect_bad_json(good, {{"distortion", {1, 2, 3}}}, "E-CAM-VALUE");
    expect_bad_json(good, {{"pixel_center", 1}}, "E-CAM-VALUE");
    expect_bad_json(good, {{"fov", 90}}, "E-CAM-VALUE");
    folder_.write("c.json", "{");
    expect_result(render("box.gltf", {"--camera-json", "c.json"}), 65, "E-JSON-SYNTAX");
    expect_result(render("box.gltf", {"--camera-json", "no.json"}), 67, "E-CAMJSON-MISSING");
    folder_.write("c.json", good.dump());
    expect_result(
        render("box.gltf", {"--camera-json", "c.json", "--camera", "0"}), 64, "E-USAGE-CONFLICT");
}

}  // namespace
}  // namespace obscura
