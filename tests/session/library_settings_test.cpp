// tests/session/library_settings_test.cpp - what views, looks and sampling of the library ask for.
// SPDX-License-Identifier: Apache-2.0
#include "base/setting_names.h"

#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <gtest/gtest.h>

#include "support/library_view.h"
#include "support/temp_folder.h"
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <obscura/obscura.h>
#include <regex>
#include <string>

namespace obscura {
namespace {

const std::string assets = OBSCURA_SOURCE_DIR "/assets/";

/// The image, or a failed test.
Image value_of(const Result<Image>& result) {
    EXPECT_TRUE(result) << result.error().text;
    return result ? *result : Image{};
}

/// An open shutter blurs the image and changes no vector, and stands in the file's header.
TEST(LibrarySettings, AShutterChangesNoMotionVector) {
    Session session;
    AssetOptions options;
    options.fps = 24;
    const Result<Asset> asset = session.open(assets + "motion/motion.glb", options);
    ASSERT_TRUE(asset);
    View view = small_view();
    view.time_s = 0.75;
    Sampling sampling;
    sampling.samples_per_pixel = 3;
    sampling.aov = {"motion"};
    // At silhouettes another moment shows other surfaces.
    const auto sums_of_lengths = [&] {
        const Image image = value_of(session.render(*asset, view, {}, sampling));
        std::array<double, 4> sums = {};
        for (size_t i = 0; i < image.layers[0].pixels.size(); ++i)
            sums[i % 4] += std::abs(static_cast<double>(image.layers[0].pixels[i]));
        return sums;
    };
    const std::array<double, 4> sharp = sums_of_lengths();
    view.shutter_s = {{-0.01, 0.01}};
    const std::array<double, 4> blurred = sums_of_lengths();
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_GT(sharp[i], 1) << i;
        EXPECT_NEAR(blurred[i], sharp[i], 0.1 * sharp[i]) << i;
    }
    const TempFolder folder;
    const Image image = value_of(session.render(*asset, view, {}, sampling));
    ASSERT_TRUE(session.write(image, folder / "shutter.exr"));
    const Imf::InputFile file((folder / "shutter.exr").string().c_str());
    const auto* time = file.header().findTypedAttribute<Imf::FloatAttribute>("expTime");
    ASSERT_NE(time, nullptr);
    EXPECT_NEAR(time->value(), 0.02, 1e-6);
}

TEST(LibrarySettings, EnumerationsAreCheckedToo) {
    Session session;
    const Result<Asset> asset = session.open(assets + "cornell/cornell.gltf");
    ASSERT_TRUE(asset);
    const auto refused = [&](const View& view, const Look& look, const Sampling& sampling) {
        const Result<Image> image = session.render(*asset, view, look, sampling);
        return image ? "nothing" : image.error().id + " " + image.error().place;
    };
    View view = small_view();
    view.camera_model = static_cast<CameraModel>(77);
    EXPECT_EQ(refused(view, {}, {}), "E-USAGE-CHOICE camera_model");
    Look look;
    look.background = static_cast<Background>(-1);
    EXPECT_EQ(refused(small_view(), look, {}), "E-USAGE-CHOICE background");
    Sampling sampling;
    sampling.integrator = static_cast<Integrator>(99);
    EXPECT_EQ(refused(small_view(), {}, sampling), "E-USAGE-CHOICE integrator");
    sampling.integrator = Integrator::path;
    sampling.filter = static_cast<PixelFilter>(9);
    EXPECT_EQ(refused(small_view(), {}, sampling), "E-USAGE-CHOICE filter");
    view.camera_model.reset();
    view.fov_deg = 400;
    EXPECT_EQ(refused(view, {}, {}), "E-USAGE-RANGE fov_deg");
    WriteOptions layout;
    layout.exr_layout = static_cast<ExrLayout>(9);
    const Image image = value_of(session.render(*asset, small_view(), {}, {}));
    const TempFolder folder;
    const Result<void> written = session.write(image, folder / "a.exr", layout);
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().place, "exr_layout");
}

/// Settings that the library has.
constexpr const char* settings[] = {"animation",
                                    "ao-distance",
                                    "aov",
                                    "bits",
                                    "blade-rotation",
                                    "camera",
                                    "camera-model",
                                    "clamp-direct",
                                    "crop",
                                    "display",
                                    "env",
                                    "environment",
                                    "ev100",
                                    "exposure",
                                    "exposure-time",
                                    "exr-layout",
                                    "eye",
                                    "far",
                                    "fisheye",
                                    "fisheye-coefficients",
                                    "float",
                                    "focal-length",
                                    "focus-distance",
                                    "focus-on",
                                    "fov",
                                    "fps",
                                    "fstop",
                                    "integrator",
                                    "isa",
                                    "iso",
                                    "lenient",
                                    "lens-radius",
                                    "line-width",
                                    "mag",
                                    "near",
                                    "noise-target",
                                    "occlusion",
                                    "ocio",
                                    "page",
                                    "point-size",
                                    "scene",
                                    "sensor",
                                    "shift",
                                    "shutter",
                                    "size",
                                    "spp",
                                    "spp-min",
                                    "stereo",
                                    "target",
                                    "time",
                                    "up",
                                    "variant",
                                    "view",
                                    "wire-width"};

/// What errors call a field is what it is called.
TEST(LibrarySettings, FieldsOfErrorsAreInTheHeaders) {
    std::string headers;
    for (const char* name : {"asset.h", "control.h", "image.h", "view.h"}) {
        std::ifstream file(std::string(OBSCURA_SOURCE_DIR "/include/obscura/") + name);
        headers.append(std::istreambuf_iterator<char>(file), {});
    }
    for (const char* one : settings) {
        const std::string field = spell_settings(setting(one), SettingNames::fields);
        EXPECT_TRUE(std::regex_search(headers, std::regex("\\b" + field + "\\b"))) << field;
    }
}

}  // namespace
}  // namespace obscura
