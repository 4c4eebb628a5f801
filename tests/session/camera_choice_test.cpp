// tests/session/camera_choice_test.cpp - which camera is chosen, and how the options change it.
// SPDX-License-Identifier: Apache-2.0
#include "session/camera_choice.h"

#include "base/setting_names.h"
#include "session/framing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <gmock/gmock.h>

namespace obscura {
namespace {

using testing::HasSubstr;

SceneCamera perspective(const char* name, double aspect, double x) {
    SceneCamera camera;
    camera.name = name;
    camera.yfov_rad = 0.6;
    camera.aspect = aspect;
    camera.znear_m = 0.1;
    camera.world_from_camera.m[0][3] = x;
    camera.world_from_camera.m[2][3] = 10;
    return camera;
}

SceneCamera orthographic(const char* name, double xmag, double ymag) {
    SceneCamera camera = perspective(name, 0, 0);
    camera.type = SceneCameraType::orthographic;
    camera.xmag_m = xmag;
    camera.ymag_m = ymag;
    return camera;
}

Scene scene_with(std::vector<SceneCamera> cameras) {
    Scene scene;
    scene.bounds = {{-1, -1, -1}, {1, 1, 1}};
    scene.cameras = std::move(cameras);
    scene.info.file_name = "test.gltf";
    return scene;
}

Result<ChosenCamera> choose(const Scene& scene,
                            const CameraRequest& request,
                            int width = 200,
                            int height = 100) {
    Log log(Verbosity::quiet);
    return choose_camera(scene, request, width, height, log);
}

Framing framing_of(const Scene& scene) {
    return frame_view(FramedGeometry(scene.bounds), {}, {default_yfov_rad, 2, false});
}

TEST(CameraChoice, TheFirstCameraOfTheFileIsTheDefault) {
    const Scene scene = scene_with({perspective("A", 0, 1), perspective("B", 0, 2)});
    const Result<ChosenCamera> chosen = choose(scene, {});
    ASSERT_TRUE(chosen);
    EXPECT_EQ(chosen->camera.world_from_camera.m[0][3], 1);
    EXPECT_THAT(chosen->description, HasSubstr("'A'"));
    EXPECT_NEAR(chosen->camera.pinhole.tan_half_yfov, std::tan(0.3), 1e-6);
    EXPECT_FLOAT_EQ(chosen->camera.pinhole.aspect, 2);
    EXPECT_NEAR(chosen->camera.pinhole.pixel_spread, 2 * std::tan(0.3) / 100, 1e-8);
}

TEST(CameraChoice, ByNameBeforeIndex) {
    const Scene scene = scene_with({perspective("1", 0, 1), perspective("B", 0, 2)});
    EXPECT_EQ(choose(scene, {.choice = "1"})->camera.world_from_camera.m[0][3], 1);
    EXPECT_EQ(choose(scene, {.choice = "B"})->camera.world_from_camera.m[0][3], 2);
    EXPECT_EQ(choose(scene, {.choice = "0"})->camera.world_from_camera.m[0][3], 1);
}

TEST(CameraChoice, UnknownAndAmbiguousNamesListWhatThereIs) {
    const Scene scene = scene_with({perspective("Twin", 0, 1), perspective("Twin", 0, 2)});
    const Result<ChosenCamera> ambiguous = choose(scene, {.choice = "Twin"});
    ASSERT_FALSE(ambiguous);
    EXPECT_EQ(ambiguous.error().id, "E-CAM-AMBIGUOUS");
    EXPECT_EQ(ambiguous.error().code, ExitCode::usage);
    EXPECT_THAT(ambiguous.error().message, HasSubstr("0 'Twin', 1 'Twin'"));
    for (const char* choice : {"twin", "2", "-1", "99999999999999999999"}) {
        const Result<ChosenCamera> unknown = choose(scene, {.choice = choice});
        ASSERT_FALSE(unknown) << choice;
        EXPECT_EQ(unknown.error().id, "E-CAM-UNKNOWN");
        EXPECT_EQ(unknown.error().code, ExitCode::usage);
        EXPECT_THAT(unknown.error().message, HasSubstr("0 'Twin', 1 'Twin'"));
    }
    const Result<ChosenCamera> none = choose(scene_with({}), {.choice = "A"});
    ASSERT_FALSE(none);
    EXPECT_THAT(none.error().message, HasSubstr("none"));
}

/// glTF 2.0, section 3.10.3: neither cropped nor stretched.
TEST(CameraChoice, APerspectiveViewIsNeverCropped) {
    const Scene scene = scene_with({perspective("A", 1.5, 0)});
    const double half_height = std::tan(0.3);
    EXPECT_NEAR(choose(scene, {}, 150, 100)->camera.pinhole.tan_half_yfov, half_height, 1e-6);
    EXPECT_NEAR(choose(scene, {}, 300, 100)->camera.pinhole.tan_half_yfov, half_height, 1e-6);
    const Camera narrow = choose(scene, {}, 75, 100)->camera;
    EXPECT_NEAR(narrow.pinhole.tan_half_yfov * narrow.pinhole.aspect, half_height * 1.5, 1e-6);
}

TEST(CameraChoice, AnOrthographicViewIsNeverCroppedOrStretched) {
    const Scene scene = scene_with({orthographic("A", 3, 2)});
    const Camera wide = choose(scene, {}, 300, 100)->camera;
    EXPECT_EQ(wide.model, CameraModel::orthographic);
    EXPECT_FLOAT_EQ(wide.orthographic.half_height_m, 2);
    EXPECT_FLOAT_EQ(wide.orthographic.half_width_m, 6);
    EXPECT_FLOAT_EQ(wide.orthographic.pixel_width_m, 0.04f);
    const Camera narrow = choose(scene, {}, 100, 100)->camera;
    EXPECT_FLOAT_EQ(narrow.orthographic.half_width_m, 3);
    EXPECT_FLOAT_EQ(narrow.orthographic.half_height_m, 3);
}

TEST(CameraChoice, FovReplacesTheVerticalAngle) {
    const Scene scene = scene_with({perspective("A", 1.5, 0)});
    const Camera camera = choose(scene, {.yfov_rad = 1.0}, 75, 100)->camera;
    EXPECT_NEAR(camera.pinhole.tan_half_yfov, std::tan(0.5), 1e-6);
}

TEST(CameraChoice, AModelKeepsWhatIsSeenAtTheScenesCentre) {
    const Scene scene = scene_with({perspective("A", 0, 0)});
    const Camera parallel = choose(scene, {.model = CameraModel::orthographic})->camera;
    EXPECT_EQ(parallel.model, CameraModel::orthographic);
    EXPECT_NEAR(parallel.orthographic.half_height_m, 10 * std::tan(0.3), 1e-5);
    const Scene flat = scene_with({orthographic("A", 2, 2)});
    const Camera pinhole = choose(flat, {.model = CameraModel::pinhole}, 100, 100)->camera;
    EXPECT_EQ(pinhole.model, CameraModel::pinhole);
    EXPECT_NEAR(pinhole.pinhole.tan_half_yfov, 0.2, 1e-6);
}

TEST(CameraChoice, WithoutACameraTheWholeSceneIsFramed) {
    const Scene scene = scene_with({});
    const Result<ChosenCamera> chosen = choose(scene, {});
    ASSERT_TRUE(chosen);
    const Framing framing = framing_of(scene);
    EXPECT_NEAR(chosen->camera.world_from_camera.m[2][3], framing.view.eye_m.z, 1e-5);
    EXPECT_THAT(chosen->description, HasSubstr("framing"));
    EXPECT_GT(chosen->znear_m, 0);
    EXPECT_GT(chosen->zfar_m, chosen->znear_m);
}

TEST(CameraChoice, TheFramingGoesBeforeTheFilesCamerasWhereItIsAskedFor) {
    const Scene scene = scene_with({perspective("A", 0, 1)});
    CameraRequest request;
    request.frames = true;
    request.framing.azimuth_rad = 0;
    request.framing.elevation_rad = 0;
    request.framing.zoom = 2;
    const Result<ChosenCamera> chosen = choose(scene, request);
    ASSERT_TRUE(chosen);
    EXPECT_THAT(chosen->description, HasSubstr("framing"));
    EXPECT_NEAR(chosen->camera.world_from_camera.m[0][3], 0, 1e-6);
    EXPECT_NEAR(chosen->camera.pinhole.tan_half_yfov, std::tan(default_yfov_rad / 2) / 2, 1e-6);
}

TEST(CameraChoice, AKeptFramingStandsStill) {
    Scene scene = scene_with({});
    CameraRequest request;
    request.kept = automatic_framing(scene, request, 2);
    request.kept->view.eye_m.z += 1;
    const Camera camera = choose(scene, request)->camera;
    EXPECT_NEAR(camera.world_from_camera.m[2][3], framing_of(scene).view.eye_m.z + 1, 1e-5);
}

TEST(CameraChoice, PlacedByHandTheRestComesFromTheFraming) {
    const Scene scene = scene_with({perspective("A", 0, 0)});
    const Framing framing = framing_of(scene);
    const Result<ChosenCamera> chosen = choose(scene, {.eye_m = Vec3d{0, 0, 7}});
    ASSERT_TRUE(chosen);
    const auto& m = chosen->camera.world_from_camera.m;
    EXPECT_FLOAT_EQ(m[2][3], 7);
    const Vec3d along = normalize(Vec3d{0, 0, 7} - framing.view.target_m);
    EXPECT_NEAR(m[0][2], along.x, 1e-6);
    EXPECT_NEAR(m[1][2], along.y, 1e-6);
    EXPECT_NEAR(chosen->camera.pinhole.tan_half_yfov, std::tan(default_yfov_rad / 2), 1e-6);

    const Camera target_only = choose(scene, {.target_m = Vec3d{5, 0, 0}})->camera;
    EXPECT_NEAR(target_only.world_from_camera.m[0][3], framing.view.eye_m.x, 1e-5);
}

TEST(CameraChoice, StraightDownNeedsNoUp) {
    const Scene scene = scene_with({});
    const CameraRequest down = {.eye_m = Vec3d{0, 9, 0}, .target_m = Vec3d{0, 0, 0}};
    const Result<ChosenCamera> chosen = choose(scene, down);
    ASSERT_TRUE(chosen);
    EXPECT_NEAR(chosen->camera.world_from_camera.m[2][1], -1, 1e-6) << "-Z is up in the picture";
    CameraRequest explicit_up = down;
    explicit_up.up = Vec3d{0, 1, 0};
    EXPECT_EQ(choose(scene, explicit_up).error().id, "E-CAM-VIEW");
}

TEST(CameraChoice, RefusesCamerasThatCannotBe) {
    Scene scene = scene_with({perspective("A", 0, 0)});
    scene.cameras[0].world_from_camera.m[2][2] = 0;
    EXPECT_EQ(choose(scene, {}).error().id, "E-CAM-SINGULAR");
    scene = scene_with({perspective("A", 0, 1e300)});
    EXPECT_EQ(choose(scene, {}).error().id, "E-CAM-RANGE");
}

TEST(CameraChoice, OptionsThatTheFilesCameraDoesNotHaveAreRefused) {
    const Scene scene = scene_with({perspective("eye", 0, 0), orthographic("plan", 2, 1)});
    const auto error_of = [&](const char* camera, const CameraSettings& settings) {
        const auto chosen = choose(scene, {.choice = camera, .settings = settings});
        return chosen ? std::string("none") : chosen.error().id + " " + chosen.error().where;
    };
    CameraSettings shift;
    shift.shift = {0.1, 0};
    EXPECT_EQ(error_of("0", shift), "none");
    EXPECT_EQ(error_of("1", shift), "E-USAGE-CONFLICT " + setting("shift"));
    CameraSettings exposure;  // an f-number that only exposes
    exposure.fstop = 8;
    exposure.shutter_s = 0.01;
    EXPECT_EQ(error_of("1", exposure), "none");
}

TEST(CameraChoice, EmptyScenesAndExtremeScalesWork) {
    for (const float scale : {0.0f, 1e-3f, 1.0f, 1e5f}) {
        Scene scene = scene_with({});
        scene.bounds =
            scale > 0 ? Bounds{{-scale, -scale, -scale}, {scale, scale, scale}} : Bounds{};
        const Result<ChosenCamera> chosen = choose(scene, {});
        ASSERT_TRUE(chosen) << scale;
        EXPECT_GT(chosen->camera.world_from_camera.m[2][3], 2 * scale);
    }
}

}  // namespace
}  // namespace obscura
