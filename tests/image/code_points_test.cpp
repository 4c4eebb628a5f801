// tests/image/code_points_test.cpp - displays are told by what they do, not by their names.
// SPDX-License-Identifier: Apache-2.0
#include "image/code_points.h"

#include "image/test_images.h"

namespace obscura {
namespace {

/// A config with one display and one view; `to_display` leads from CIE XYZ to its codes.
std::string config_with(const std::string& display, const std::string& to_display) {
    return R"(ocio_profile_version: 2
strictparsing: false
roles: {default: Linear, scene_linear: Linear, cie_xyz_d65_interchange: XYZ}
file_rules: [!<Rule> {name: Default, colorspace: default}]
displays:
  )" + display +
           R"(: [!<View> {name: Plain, view_transform: Plain, display_colorspace: Screen}]
view_transforms:
  - !<ViewTransform>
    name: Plain
    from_scene_reference: !<BuiltinTransform> {style: UTILITY - ACES-AP0_to_CIE-XYZ-D65_BFD}
display_colorspaces:
  - !<ColorSpace> {name: XYZ}
  - !<ColorSpace>
    name: Screen
    from_display_reference: )" +
           to_display + R"(
colorspaces:
  - !<ColorSpace>
    name: Linear
    aliases: [lin_rec709_scene]
)";
}

std::string builtin(const std::string& style) {
    return "!<BuiltinTransform> {style: DISPLAY - CIE-XYZ-D65_to_" + style + "}";
}

class CodePoints : public testing_images::FolderTest {
protected:
    std::optional<ColorCodePoints> found(const std::string& config) {
        const std::string file = (folder_ / "config.ocio").string();
        std::ofstream(file) << config;
        const auto display = DisplayTransform::create({file, {}, {}, 0}, log_);
        EXPECT_TRUE(display) << display.error().message;
        return display ? display->code_points() : std::nullopt;
    }
    std::optional<ColorCodePoints> found_in_builtin(const char* view) {
        const auto display = DisplayTransform::create({{}, {}, view, 0}, log_);
        EXPECT_TRUE(display) << display.error().message;
        return display ? display->code_points() : std::nullopt;
    }

    Log log_{Verbosity::quiet};
};

TEST_F(CodePoints, TheBuiltInDisplayIsSrgbAndItsRawViewIsNothing) {
    for (const char* view : {"ACES 1.0 SDR", "Un-tone-mapped", "Khronos PBR Neutral"}) {
        EXPECT_EQ(found_in_builtin(view), (ColorCodePoints{1, 13})) << view;
    }
    EXPECT_EQ(found_in_builtin("Raw"), std::nullopt);
}

TEST_F(CodePoints, OtherDisplaysHaveTheirNumbersOrNone) {
    EXPECT_EQ(found(config_with("A", builtin("sRGB"))), (ColorCodePoints{1, 13}));
    EXPECT_EQ(found(config_with("A", builtin("REC.2100-PQ"))), (ColorCodePoints{9, 16}));
    EXPECT_EQ(found(config_with("A", builtin("ST2084-P3-D65"))), (ColorCodePoints{12, 16}));
    EXPECT_EQ(found(config_with("A", builtin("G2.2-REC.709"))), (ColorCodePoints{1, 4}));
    EXPECT_EQ(found(config_with("A", builtin("REC.1886-REC.709"))), std::nullopt);
    EXPECT_EQ(found(config_with("A", builtin("G2.6-P3-D65"))), std::nullopt);
}

/// The matrix is that of SMPTE EG 432-1 for a D65 white, as published.
TEST_F(CodePoints, DisplayP3IsItsMatrixAndTheCurveOfSrgb) {
    const std::string display_p3 = R"(!<GroupTransform>
      children:
        - !<MatrixTransform>
          matrix: [2.493497, -0.931384, -0.402711, 0, -0.829489, 1.762664, 0.023625, 0,
                   0.035846, -0.076172, 0.956885, 0, 0, 0, 0, 1]
        - !<ExponentWithLinearTransform> {gamma: 2.4, offset: 0.055, direction: inverse})";
    EXPECT_EQ(found(config_with("A", display_p3)), (ColorCodePoints{12, 13}));
}

TEST_F(CodePoints, ANameProvesNothing) {
    EXPECT_EQ(found(config_with("sRGB", builtin("G2.2-REC.709"))), (ColorCodePoints{1, 4}));
    EXPECT_EQ(found(config_with("sRGB", builtin("G2.6-P3-D65"))), std::nullopt);
}

TEST_F(CodePoints, OnlyASceneReferredViewIsTakenByItsDisplaysName) {
    const auto old_config = [](const std::string& display) {
        return "ocio_profile_version: 1\nroles: {default: Linear, scene_linear: Linear}\n"
               "displays:\n  " +
               display +
               ": [!<View> {name: Film, colorspace: Film}]\n"
               "colorspaces:\n"
               "  - !<ColorSpace> {name: Linear}\n"
               "  - !<ColorSpace> {name: Film, from_reference: !<ExponentTransform> "
               "{value: [0.5, 0.5, 0.5, 1]}}\n";
    };
    EXPECT_EQ(found(old_config("sRGB")), (ColorCodePoints{1, 13}));
    EXPECT_EQ(found(old_config("Projector")), std::nullopt);
}

}  // namespace
}  // namespace obscura
