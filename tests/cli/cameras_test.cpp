// tests/cli/cameras_test.cpp - every camera by its options: images, headers, messages.
// SPDX-License-Identifier: Apache-2.0
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include "cli/cli.h"
#include <algorithm>
#include <cmath>

namespace obscura {
namespace {

using testing::HasSubstr;
using Strings = std::vector<std::string>;

class Cameras : public Cli {
protected:
    /// Renders the box into a.exr and reads it.
    ReadImage shot(const Strings& options, const std::string& scene = "box.gltf") const {
        Strings all = {"-o", "a.exr", "--float", "--threads", "2"};
        all.insert(all.end(), options.begin(), options.end());
        expect_result(render(scene, all), 0, "OK");
        auto image = read_image_file(folder_ / "a.exr");
        EXPECT_TRUE(image);
        return image.value_or(ReadImage{});
    }
    void expect_refusal(const Strings& options, const std::string& id, const std::string& text) {
        const ProgramRun got = render("box.gltf", options);
        expect_result(got, 64, id);
        EXPECT_THAT(got.err, HasSubstr(text));
    }
    static const float* pixel(const ReadImage& image, int x, int y) {
        return &image.pixels[static_cast<size_t>(y * image.width + x) * image.channels.size()];
    }
    static double number(const ReadImage& image, const char* attribute) {
        const OIIO::ParamValue* found =
            image.spec.find_attribute(attribute, OIIO::TypeDesc::DOUBLE);
        return found != nullptr ? found->get<double>() : -1;
    }
    static std::string text(const ReadImage& image, const char* attribute) {
        return std::string(image.spec.get_string_attribute(attribute));
    }
};

TEST_F(Cameras, HeadersNameModelAndParameters) {
    const ReadImage lens = shot({"--camera-model",
                                 "thinlens",
                                 "--lens-radius",
                                 "0.25",
                                 "--focus-distance",
                                 "5",
                                 "--blades",
                                 "6"});
    EXPECT_EQ(text(lens, "obscura:projection"), "thinlens");
    EXPECT_THAT(text(lens, "obscura:cameraParameters"), HasSubstr("lens_radius_m=0.25"));
    EXPECT_THAT(text(lens, "obscura:cameraParameters"), HasSubstr("focus_distance_m=5"));
    EXPECT_THAT(text(lens, "obscura:cameraParameters"), HasSubstr("blades=6"));
    EXPECT_NE(lens.spec.find_attribute("worldToNDC"), nullptr);
    const ReadImage fisheye = shot({"--fisheye", "equisolid", "--fov", "220"});
    EXPECT_EQ(text(fisheye, "obscura:projection"), "fisheye");
    EXPECT_THAT(text(fisheye, "obscura:cameraParameters"), HasSubstr("fisheye=equisolid"));
    EXPECT_NE(fisheye.spec.find_attribute("worldToCamera"), nullptr);
    EXPECT_EQ(fisheye.spec.find_attribute("worldToNDC"), nullptr) << "there is no such matrix";
}

TEST_F(Cameras, ALensOfRadiusZeroIsAPinholeBitForBit) {
    const ReadImage pinhole = shot({"--camera-model", "pinhole"});
    const ReadImage lens =
        shot({"--camera-model", "thinlens", "--lens-radius", "0", "--focus-distance", "2"});
    EXPECT_EQ(pinhole.pixels, lens.pixels);
    EXPECT_NE(pinhole.pixels, shot({"--lens-radius", "0.2", "--focus-distance", "2"}).pixels);
}

/// Small images of whole scenes by each model, without a refused ray or a bad sample.
TEST_F(Cameras, EveryModelRenders) {
    for (const Strings& options :
         {Strings{"--fstop", "1.4"},
          Strings{"--fstop", "2", "--focal-length", "85", "--sensor", "36x24"},
          Strings{"--lens-radius", "0.1", "--blades", "5", "--blade-rotation", "20"},
          Strings{"--lens-radius", "0.1", "--anamorphic", "2"},
          Strings{"--fisheye", "equidistant", "--fov", "360"},
          Strings{"--fisheye", "stereographic", "--fisheye-fit", "diagonal"},
          Strings{"--fisheye", "orthographic", "--fov", "180"},
          Strings{"--fisheye-coefficients", "-0.1,0.01,0,0", "--fov", "150"},
          Strings{"--environment", "latlong", "--stereo", "0.06"},
          Strings{"--environment", "cylindrical", "--align", "view", "--fov", "100"},
          Strings{"--environment", "cubemap", "--size", "24x16"},
          Strings{"--distortion", "-0.9,0.2,0.01,0.01,0.3", "--fov", "120"},
          Strings{"--shift", "0.5,-0.25", "--near", "5.5", "--far", "7.5"},
          Strings{"--mag", "2,1"}}) {
        SCOPED_TRACE(testing::PrintToString(options));
        Strings all = options;
        all.insert(all.end(), {"-o", "a.exr", "--stats", "s.json"});
        expect_result(render("box.gltf", all), 0, "OK");
        const std::string stats = read_whole_file(folder_ / "s.json");
        EXPECT_THAT(stats, HasSubstr("\"refused_rays\": 0,"));
        EXPECT_THAT(stats, HasSubstr("\"nonfinite_samples\": 0"));
    }
}

/// The same once more with every AOV, whose rays pass the centres of pixels and lens.
TEST_F(Cameras, AovsGoThroughTheCentreOfTheLens) {
    const Strings depth = {"--integrator", "depth"};
    const ReadImage pinhole = shot(depth);
    EXPECT_EQ(shot({"--integrator", "depth", "--lens-radius", "0.5"}).pixels, pinhole.pixels);
    const ReadImage wide = shot({"--integrator", "depth", "--fisheye", "equidistant"});
    EXPECT_EQ(*pixel(wide, 0, 0), 0) << "outside the circle";
    EXPECT_NEAR(*pixel(wide, 12, 8), 5, 0.05) << "from the eye at (0, 0, 6) to the box";
}

TEST_F(Cameras, TheFilmsSizeAndFocalLengthAreAnAngle) {
    const std::string fov = std::to_string(2 * std::atan(12.0 / 50) * 180 / 3.14159265358979);
    const ReadImage by_angle = shot({"--fov", fov});
    const ReadImage by_film = shot({"--focal-length", "50", "--sensor", "36x24"});
    EXPECT_EQ(by_angle.spec.get_string_attribute("obscura:projection"), "pinhole");
    for (size_t i = 0; i < by_angle.pixels.size(); ++i)
        EXPECT_NEAR(by_angle.pixels[i], by_film.pixels[i], 0.35f) << i;
    EXPECT_THAT(text(by_film, "obscura:cameraParameters"), HasSubstr("yfov_deg=26.99"));
    expect_refusal({"--focal-length", "50"}, "E-CAM-LENS", "--sensor");
}

TEST_F(Cameras, ShiftMovesTheImageByWholeImages) {
    const Strings albedo = {"--integrator", "normal"};
    const ReadImage plain = shot(albedo);
    const ReadImage shifted = shot({"--integrator", "normal", "--shift", "0.25,0"});
    for (int x = 0; x < 18; ++x) {  // a quarter of 24 pixels
        for (int y = 0; y < 16; ++y)
            EXPECT_EQ(*pixel(shifted, x, y), *pixel(plain, x + 6, y));
    }
}

TEST_F(Cameras, ClippingHidesAndKeepsDepths) {
    const auto depth = [&](const Strings& more) {
        Strings all = {"--integrator", "depth"};
        all.insert(all.end(), more.begin(), more.end());
        return *pixel(shot(all, "quad.gltf"), 12, 8);
    };
    EXPECT_NEAR(depth({}), 3, 1e-5);
    EXPECT_NEAR(depth({"--near", "1", "--far", "4"}), 3, 1e-5);
    EXPECT_EQ(depth({"--near", "3.1"}), 0);
    EXPECT_EQ(depth({"--far", "2.9"}), 0);
    expect_refusal({"--near", "3", "--far", "2"}, "E-CAM-CLIP", "larger");
}

TEST_F(Cameras, AutofocusFindsThePixelsDistance) {
    const ReadImage focused =
        shot({"--fstop", "1.4", "--focal-length", "50", "--sensor", "36x24", "--focus-on", "12,8"},
             "quad.gltf");
    EXPECT_THAT(text(focused, "obscura:cameraParameters"), HasSubstr("focus_distance_m=3"));
    expect_refusal({"--fstop", "2", "--focus-on", "0,0"}, "E-CAM-FOCUS", "nothing to focus on");
    expect_refusal({"--fstop", "2", "--focus-on", "24,0"}, "E-CAM-FOCUS", "24x16");
}

/// The mean of a pixel's samples in a map interpolated between texels: in each direction six parts
/// of the texel itself and one of each neighbour.
float seen_in_map(const ReadImage& map, int x, int y, size_t channel) {
    const float weights[3] = {1.0f / 8, 6.0f / 8, 1.0f / 8};
    float sum = 0;
    for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
            const int row = std::clamp(y + dy, 0, map.height - 1);
            const int column = (x + dx + map.width) % map.width;
            sum += weights[dx + 1] * weights[dy + 1] *
                   map.pixels[static_cast<size_t>(row * map.width + column) * 4 + channel];
        }
    }
    return sum;
}

/// An image of all directions is an environment map that reproduces itself, with any camera.
TEST_F(Cameras, ALatLongImageUsedAsEnvironmentReproducesItself) {
    const Strings around = {"--environment", "latlong", "--size", "64x32", "--spp", "256"};
    Strings first = around;
    first.insert(first.end(), {"--camera", "Front", "--background", "0.2,0.3,0.4"});
    const ReadImage map = shot(first);
    std::filesystem::rename(folder_ / "a.exr", folder_ / "map.exr");
    Strings second = around;
    second.insert(second.end(), {"--camera", "Top", "--env", "map.exr", "--far", "0.001"});
    const ReadImage again = shot(second);
    double difference = 0;
    float contrast = 0;
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 64; ++x) {
            for (size_t c = 0; c < 3; ++c) {
                const float wanted = seen_in_map(map, x, y, c);
                EXPECT_NEAR(pixel(again, x, y)[c], wanted, 0.02f) << x << " " << y;
                difference += std::abs(pixel(again, x, y)[c] - wanted);
                contrast = std::max(contrast, std::abs(wanted - pixel(map, 0, 0)[c]));
            }
        }
    }
    EXPECT_GT(contrast, 0.1f) << "the box can be told from what is around it";
    EXPECT_LT(difference / (64 * 32 * 3), 5e-4);
}

TEST_F(Cameras, PhotographicExposureDarkensTheDisplayOnly) {
    const Strings frame = {"-o", "a.png", "-o", "a.exr"};
    const auto png = [&](const Strings& more) {
        Strings all = frame;
        all.insert(all.end(), more.begin(), more.end());
        expect_result(render("quad.gltf", all), 0, "OK");
        return read_image_file(folder_ / "a.png")->pixels;
    };
    // EV100 of f/2, 1/2 s, ISO 200 is 2; 1 / (1.2 * 4) is 2^-2.263.
    const std::vector<float> by_hand = png({"--exposure", "-2.2630344058"});
    const auto exr = read_image_file(folder_ / "a.exr")->pixels;
    EXPECT_EQ(png({"--ev100", "2"}), by_hand);
    EXPECT_EQ(png({"--fstop", "2", "--shutter", "1/2", "--iso", "200"}), by_hand);
    const auto exposed = read_image_file(folder_ / "a.exr");
    EXPECT_EQ(exposed->pixels, exr);
    EXPECT_EQ(text(*exposed, "obscura:projection"), "pinhole")
        << "the f-number is for the exposure";
    EXPECT_EQ(number(*exposed, "obscura:ev100"), 2);
    EXPECT_NEAR(number(*exposed, "obscura:exposureScale"), 1 / 4.8, 1e-12);
    const Imf::InputFile file((folder_ / "a.exr").c_str());
    EXPECT_EQ(Imf::aperture(file.header()), 2);
    EXPECT_EQ(Imf::expTime(file.header()), 0.5f);
    EXPECT_EQ(Imf::isoSpeed(file.header()), 200);
    expect_refusal({"--shutter", "1"}, "E-CAM-EXPOSURE", "--fstop");
}

TEST_F(Cameras, ImpossibleCamerasAreRefusedWithWhatWouldDo) {
    expect_refusal({"--camera-model", "lens"}, "E-USAGE-CHOICE", "thinlens, fisheye");
    expect_refusal({"--camera-model", "thinlens"}, "E-CAM-LENS", "--fstop");
    expect_refusal({"--fisheye", "orthographic", "--fov", "200"}, "E-CAM-FISHEYE", "180");
    expect_refusal({"--fisheye", "round"}, "E-USAGE-CHOICE", "stereographic");
    expect_refusal({"--environment", "cubemap", "--size", "100x100"}, "E-CAM-SIZE", "6:1");
    expect_refusal({"--stereo", "1", "--size", "8x7"}, "E-CAM-SIZE", "even");
    expect_refusal({"--fstop", "2", "--lens-radius", "1"}, "E-USAGE-CONFLICT", "--fstop");
    expect_refusal({"--camera-model", "pinhole", "--blades", "5"}, "E-USAGE-CONFLICT", "pinhole");
    expect_refusal({"--distortion", "1,2,3"}, "E-USAGE-NUMBER", "K1,K2,P1,P2");
    expect_refusal({"--sensor", "36,24", "--focal-length", "9"}, "E-USAGE-NUMBER", "36x24");
    expect_refusal({"--shutter", "1/0", "--fstop", "2"}, "E-USAGE-RANGE", "--shutter");
    expect_refusal({"--fstop", "2", "--focal-length", "5000", "--focus-distance", "1"},
                   "E-CAM-LENS",
                   "larger distance");
}

TEST_F(Cameras, AnAperturesImageIsReadOrRefused) {
    expect_result(render("quad.gltf", {"-o", "a.png"}), 0, "OK");
    const Strings lens = {"--lens-radius", "0.1", "--aperture"};
    const auto with = [&](const std::string& file) {
        Strings all = lens;
        all.push_back(file);
        return render("box.gltf", all);
    };
    expect_result(with("a.png"), 0, "OK");
    expect_result(with("missing.png"), 67, "E-APERTURE-MISSING");
    expect_result(
        render("quad.gltf", {"-o", "black.png", "--far", "0.1", "--background", "0,0,0"}), 0, "OK");
    expect_result(with("black.png"), 67, "E-APERTURE-BLACK");
}

TEST_F(Cameras, FramesAnyPartFromAnySide) {
    expect_result(
        render("box.gltf", {"--camera", "auto", "--azimuth", "-90", "--zoom", "2"}), 0, "OK");
    expect_result(render("box.gltf", {"--focus-node", "Nowhere"}), 64, "E-NODE-UNKNOWN");
    expect_result(render("box.gltf", {"--focus-node", "node 0", "--margin", "0"}), 0, "OK");
    expect_result(render("box.gltf", {"--azimuth", "0", "--eye", "1,2,3"}), 64, "E-USAGE-CONFLICT");
    expect_result(render("box.gltf", {"--margin", "50"}), 64, "E-USAGE-RANGE");
}

}  // namespace
}  // namespace obscura
