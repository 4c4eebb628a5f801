// tests/session/library_cameras_test.cpp - the library's cameras: computer vision's, every setting.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/library_view.h"
#include "support/temp_folder.h"
#include <cmath>
#include <obscura/obscura.h>

namespace obscura {
namespace {

const std::string assets = OBSCURA_SOURCE_DIR "/assets/";

std::vector<float> pixels_of(const std::string& file, const View& view) {
    Session session;
    const Result<Asset> asset = session.open(file);
    EXPECT_TRUE(asset) << asset.error().text;
    Sampling sampling;
    sampling.samples_per_pixel = 3;
    const Result<Image> image = session.render(*asset, view, {}, sampling);
    EXPECT_TRUE(image) << image.error().text;
    return image ? image->pixels : std::vector<float>{};
}

TEST(LibraryCameras, CamerasOfComputerVisionAreScaledToTheImage) {
    const std::string file = assets + "cornell/cornell.gltf";
    const TempFolder folder;
    View large = small_view();
    large.camera_json = folder
                            .write("large.json",
                                   R"({"width": 80, "height": 48, "fx": 60, "fy": 60,
"R": [[1, 0, 0], [0, -1, 0], [0, 0, -1]], "t": [0, 1, 4]})")
                            .string();
    View small = small_view();
    small.camera_json = folder
                            .write("small.json",
                                   R"({"width": 40, "height": 24, "fx": 30, "fy": 30,
"R": [[1, 0, 0], [0, -1, 0], [0, 0, -1]], "t": [0, 1, 4]})")
                            .string();
    const std::vector<float> pixels = pixels_of(file, small);
    EXPECT_EQ(pixels_of(file, large), pixels);
    EXPECT_NE(pixels_of(file, small_view()), pixels);
    Session session;
    const Result<Asset> asset = session.open(file);
    ASSERT_TRUE(asset);
    small.camera_json = (folder / "none.json").string();
    const Result<Image> missing = session.render(*asset, small);
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().id, "E-CAMJSON-MISSING");
}

TEST(LibraryCameras, CamerasOfOpenCvAreThoseOfAFile) {
    const std::string file = assets + "cornell/cornell.gltf";
    const TempFolder folder;
    View from_file = small_view();
    from_file.camera_json = folder
                                .write("bent.json",
                                       R"({"width": 80, "height": 48, "pixel_center": 0,
"K": [[60, 0, 41], [0, 61, 22], [0, 0, 1]], "distortion": [-0.1, 0.01, 0.001, 0.002, 0],
"R": [[0.8, 0, -0.6], [0, -1, 0], [-0.6, 0, -0.8]], "t": [0.3, 1.1, 4]})")
                                .string();
    OpenCvCamera camera;
    camera.K = {60, 0, 41, 0, 61, 22, 0, 0, 1};
    camera.R = {0.8, 0, -0.6, 0, -1, 0, -0.6, 0, -0.8};
    camera.t = {0.3, 1.1, 4};
    camera.width = 80;
    camera.height = 48;
    camera.pixel_center = 0;
    View given = small_view();
    given.opencv = camera;
    given.distortion = {{-0.1, 0.01, 0.001, 0.002, 0}};
    EXPECT_EQ(pixels_of(file, given), pixels_of(file, from_file));

    Session session;
    const Result<Asset> asset = session.open(file);
    ASSERT_TRUE(asset);
    const auto error_of = [&](void (*change)(View&, OpenCvCamera&)) {
        View view = small_view();
        OpenCvCamera changed = camera;
        change(view, changed);
        view.opencv = changed;
        const Result<Image> image = session.render(*asset, view);
        return image ? "none" : image.error().place + " " + image.error().id;
    };
    EXPECT_EQ(error_of([](View&, OpenCvCamera& c) { c.K[1] = 2; }), "opencv#/K E-CAM-VALUE");
    EXPECT_EQ(error_of([](View&, OpenCvCamera& c) { c.K[2] = NAN; }), "opencv#/K E-CAM-VALUE");
    EXPECT_EQ(error_of([](View&, OpenCvCamera& c) { c.R[0] = 2; }), "opencv#/R E-CAM-MATRIX");
    EXPECT_EQ(error_of([](View&, OpenCvCamera& c) { c.t[0] = INFINITY; }), "opencv#/t E-CAM-VALUE");
    EXPECT_EQ(error_of([](View&, OpenCvCamera& c) { c.width = -1; }), "opencv#/width E-CAM-VALUE");
    EXPECT_EQ(error_of([](View& v, OpenCvCamera&) { v.camera = "0"; }), "opencv E-USAGE-CONFLICT");
    EXPECT_EQ(error_of([](View& v, OpenCvCamera&) { v.camera_json = "c.json"; }),
              "opencv E-USAGE-CONFLICT");
}

TEST(LibraryCameras, EverySettingOfACameraIsAField) {
    const std::string file = assets + "cornell/cornell.gltf";
    View fisheye = small_view();
    fisheye.fisheye = "opencv";
    View diagonal = fisheye;
    diagonal.fisheye_fit = "diagonal";
    EXPECT_NE(pixels_of(file, fisheye), pixels_of(file, diagonal));
    View bent = fisheye;
    bent.fisheye_coefficients = {{0.1, 0.02, 0, 0}};
    EXPECT_NE(pixels_of(file, fisheye), pixels_of(file, bent));
    View around = small_view();
    around.camera_model = CameraModel::environment;
    View eyes = around;
    eyes.stereo_m = 0.2;
    EXPECT_NE(pixels_of(file, around), pixels_of(file, eyes));
    View ahead = around;
    ahead.align = "view";
    EXPECT_NE(pixels_of(file, around), pixels_of(file, ahead));
    View barrel = small_view();
    barrel.distortion = {{-0.2, 0, 0, 0, 0}};
    EXPECT_NE(pixels_of(file, small_view()), pixels_of(file, barrel));
    View opened = small_view();
    opened.fstop = 2;
    opened.aperture = "none.png";
    Session session;
    const Result<Asset> asset = session.open(file);
    ASSERT_TRUE(asset);
    const Result<Image> missing = session.render(*asset, opened);
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().id, "E-APERTURE-MISSING");
}

}  // namespace
}  // namespace obscura
