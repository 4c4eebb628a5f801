// tests/image/display_test.cpp - every view of the built-in config, and other people's configs.
// SPDX-License-Identifier: Apache-2.0
#include "image/display.h"

#include "base/setting_names.h"
#include "image/pbr_neutral.h"
#include "image/test_images.h"

#include <OpenColorIO/OpenColorIO.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <thread>

namespace obscura {
namespace {

using Rgb = std::array<float, 3>;

double srgb_code(double linear) {
    linear = std::clamp(linear, 0.0, 1.0);
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

class Display : public testing_images::FolderTest {
protected:
    void SetUp() override {
        FolderTest::SetUp();
        ::unsetenv("OCIO");
    }
    void TearDown() override {
        ::unsetenv("OCIO");
        FolderTest::TearDown();
    }

    Rgb shown(const DisplayOptions& options, Rgb rgb) {
        const Result<DisplayTransform> transform = DisplayTransform::create(options, log_);
        EXPECT_TRUE(transform) << transform.error().where << ": " << transform.error().message;
        if (transform) transform->apply(rgb.data(), 1);
        return rgb;
    }
    Rgb shown(const std::string& view, Rgb rgb, double exposure_ev = 0) {
        return shown(DisplayOptions{{}, {}, view, exposure_ev}, rgb);
    }

    Error error_of(const DisplayOptions& options) {
        const Result<DisplayTransform> transform = DisplayTransform::create(options, log_);
        EXPECT_FALSE(transform);
        if (transform) return {};
        EXPECT_EQ(transform.error().code, ExitCode::configuration);
        return transform.error();
    }

    std::string write_config(const std::string& text) {
        const std::filesystem::path file = folder_ / "config.ocio";
        std::ofstream(file) << text;
        return file.string();
    }

    Log log_{Verbosity::quiet};
};

std::vector<Rgb> colors() {
    std::vector<Rgb> list;
    for (const float r : {0.0f, 0.001f, 0.003f, 0.02f, 0.18f, 0.5f, 1.0f}) {
        for (const float g : {0.0f, 0.01f, 0.3f, 1.0f}) {
            for (const float b : {0.0f, 0.1f, 0.9f})
                list.push_back({r, g, b});
        }
    }
    return list;
}

TEST_F(Display, UnToneMappedIsTheSrgbCurve) {
    for (const Rgb& in : colors()) {
        const Rgb out = shown("Un-tone-mapped", in);
        for (size_t i = 0; i < 3; ++i) {
            ASSERT_NEAR(out[i], srgb_code(in[i]), 2e-4) << in[0] << " " << in[1] << " " << in[2];
        }
    }
    EXPECT_EQ(shown("Un-tone-mapped", {2, 100, 1e30f}), (Rgb{1, 1, 1}));
    EXPECT_EQ(shown("Un-tone-mapped", {-2, -0.1f, -1e30f}), (Rgb{0, 0, 0}));
}

TEST_F(Display, PbrNeutralIsItsFormulaAndTheSrgbCurve) {
    for (const Rgb& in : colors()) {
        for (const float level : {1.0f, 4.0f, 30.0f}) {
            double expected[3] = {
                double{in[0] * level}, double{in[1] * level}, double{in[2] * level}};
            tone_map_pbr_neutral(expected);
            const Rgb out =
                shown("Khronos PBR Neutral", {in[0] * level, in[1] * level, in[2] * level});
            for (size_t i = 0; i < 3; ++i)
                ASSERT_NEAR(out[i], srgb_code(expected[i]), 2e-4);
        }
    }
}

TEST_F(Display, OtherSpacesBecomeRec709First) {
    DisplayOptions options;
    options.rec709_from_scene = Matrix3{{{1.5, -0.25, -0.25}, {0, 1, 0}, {-0.1, -0.2, 1.3}}};
    for (const char* view : {"Un-tone-mapped", "Khronos PBR Neutral", "ACES 1.0 SDR"}) {
        options.view = view;
        const Rgb out = shown(options, {0.4f, 0.6f, 0.3f});
        const Rgb expected = shown(view, {0.375f, 0.6f, 0.23f});
        for (size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(out[i], expected[i], 1e-4) << view;
    }
}

TEST_F(Display, RawIsTheIdentityInRange) {
    EXPECT_EQ(shown("Raw", {0.25f, 0.123456f, 0.9f}), (Rgb{0.25f, 0.123456f, 0.9f}));
    EXPECT_EQ(shown("Raw", {-1, 2, 0}), (Rgb{0, 1, 0}));
}

TEST_F(Display, AcesMidGreyIsPlausibleNeutralAndMonotone) {
    // The ACES 1.0 output transform shows 18 % grey at about 10 nits of 100: sRGB code 0.35.
    const Rgb grey = shown("ACES 1.0 SDR", {0.18f, 0.18f, 0.18f});
    EXPECT_NEAR(grey[0], 0.35, 0.015);
    float before = -1;
    for (float level = 0.0001f; level < 100; level *= 1.3f) {
        const Rgb out = shown("ACES 1.0 SDR", {level, level, level});
        EXPECT_NEAR(out[0], out[1], 2e-3) << level;
        EXPECT_NEAR(out[1], out[2], 2e-3) << level;
        EXPECT_GE(out[1], before) << level;
        before = out[1];
    }
    EXPECT_GT(before, 0.99f);
    const Rgb red = shown("ACES 1.0 SDR", {0.5f, 0.02f, 0.02f});
    EXPECT_GT(red[0], 2 * red[1]);
}

TEST_F(Display, TheDefaultIsAcesOnSrgb) {
    const Rgb in{0.3f, 0.2f, 0.1f};
    EXPECT_EQ(shown(DisplayOptions{}, in), shown("ACES 1.0 SDR", in));
    EXPECT_EQ(shown(DisplayOptions{{}, "sRGB", {}, 0}, in), shown("ACES 1.0 SDR", in));
    EXPECT_TRUE(log_.warnings().empty());
}

TEST_F(Display, NamesMayBeWrittenInAnyCase) {
    const Rgb in{0.3f, 0.2f, 0.1f};
    EXPECT_EQ(shown(DisplayOptions{{}, "SRGB", "un-TONE-mapped", 0}, in),
              shown("Un-tone-mapped", in));
    EXPECT_EQ(shown("khronos pbr neutral", {3, 2, 1}), shown("Khronos PBR Neutral", {3, 2, 1}));
}

TEST_F(Display, ExposureMultipliesByPowersOfTwo) {
    for (const char* view : {"ACES 1.0 SDR", "Un-tone-mapped", "Khronos PBR Neutral", "Raw"}) {
        EXPECT_EQ(shown(view, {0.1f, 0.05f, 0.2f}, 1), shown(view, {0.2f, 0.1f, 0.4f})) << view;
        EXPECT_EQ(shown(view, {0.8f, 0.4f, 0.2f}, -2), shown(view, {0.2f, 0.1f, 0.05f})) << view;
    }
}

TEST_F(Display, OddValuesAndExposuresStayInRange) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (const char* view : {"ACES 1.0 SDR", "Un-tone-mapped", "Khronos PBR Neutral", "Raw"}) {
        for (const double exposure : {0.0, 1e6, -1e6}) {
            for (const Rgb& in : {Rgb{nan, nan, nan},
                                  Rgb{infinity, 0, -infinity},
                                  Rgb{3e38f, 1e-40f, -3e38f},
                                  Rgb{nan, infinity, 0.5f}}) {
                for (const float value : shown(view, in, exposure)) {
                    EXPECT_TRUE(value >= 0 && value <= 1) << view << " " << value;
                }
            }
        }
    }
    EXPECT_EQ(shown("Raw", {nan, 0.5f, infinity}), (Rgb{0, 0.5f, 1}));
}

TEST_F(Display, ManyPixelsAndManyThreadsGiveTheSameAsOne) {
    const Result<DisplayTransform> transform = DisplayTransform::create({}, log_);
    ASSERT_TRUE(transform);
    std::vector<float> values(3 * 10007);
    for (size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<float>(i % 977) / 400;
    std::vector<float> alone = values;
    for (size_t i = 0; i < 10007; i += 97)
        transform->apply(alone.data() + 3 * i, 1);
    std::vector<float> first = values;
    std::vector<float> second = values;
    std::thread other([&] { transform->apply(first.data(), 10007); });
    transform->apply(second.data(), 10007);
    other.join();
    EXPECT_EQ(first, second);
    for (size_t i = 0; i < 3 * 10007; i += 3 * 97)
        ASSERT_EQ(alone[i], first[i]) << i;
}

TEST_F(Display, UnknownNamesAre78AndListWhatThereIs) {
    const Error display = error_of(DisplayOptions{{}, "Projector", {}, 0});
    EXPECT_EQ(display.id, "E-OCIO-DISPLAY");
    EXPECT_EQ(display.where, setting("display") + " Projector");
    EXPECT_NE(display.message.find("'sRGB'"), std::string::npos) << display.message;
    const Error view = error_of(DisplayOptions{{}, {}, "Filmic", 0});
    EXPECT_EQ(view.id, "E-OCIO-VIEW");
    EXPECT_EQ(view.where, setting("view") + " Filmic");
    for (const char* name :
         {"'ACES 1.0 SDR'", "'Un-tone-mapped'", "'Khronos PBR Neutral'", "'Raw'"}) {
        EXPECT_NE(view.message.find(name), std::string::npos) << view.message;
    }
}

TEST_F(Display, UnreadableConfigsAre78) {
    write_config("this: is: not: [yaml");
    for (const std::string& file : {folder_.string(),
                                    (folder_ / "absent.ocio").string(),
                                    std::string("/dev/zero"),
                                    (folder_ / "config.ocio").string()}) {
        const Error by_option = error_of(DisplayOptions{file, {}, {}, 0});
        EXPECT_EQ(by_option.id, "E-OCIO-FILE");
        EXPECT_EQ(by_option.where, setting("ocio") + " " + file);
        EXPECT_FALSE(by_option.message.empty());
        ::setenv("OCIO", file.c_str(), 1);
        const Error by_variable = error_of(DisplayOptions{});
        ::unsetenv("OCIO");
        EXPECT_EQ(by_variable.id, "E-OCIO-FILE");
        EXPECT_EQ(by_variable.where, "$OCIO " + file);
    }
}

/// A config of one display and one view; `spaces` are colour spaces beside the role's.
std::string small_config(const std::string& roles, const std::string& spaces) {
    return "ocio_profile_version: 2\nroles:\n" + roles +
           "file_rules:\n  - !<Rule> {name: Default, colorspace: working}\n"
           "displays:\n  screen:\n    - !<View> {name: plain, colorspace: working}\n"
           "colorspaces:\n  - !<ColorSpace> {name: working}\n" +
           spaces;
}

TEST_F(Display, TheOptionOverridesTheVariable) {
    const std::string file = write_config(small_config("  scene_linear: working\n", ""));
    ::setenv("OCIO", "/nowhere/absent.ocio", 1);
    EXPECT_EQ(shown(DisplayOptions{file, {}, "plain", 0}, {0.25f, 0.5f, 0.75f}),
              (Rgb{0.25f, 0.5f, 0.75f}));
    ::setenv("OCIO", file.c_str(), 1);
    EXPECT_EQ(shown(DisplayOptions{{}, "screen", "plain", 1}, {0.25f, 0.5f, 0.25f}),
              (Rgb{0.5f, 1, 0.5f}));
    ::setenv("OCIO", "", 1);
    EXPECT_EQ(shown("Raw", {0.25f, 0.5f, 0.75f}), (Rgb{0.25f, 0.5f, 0.75f}));
}

TEST_F(Display, SceneLinearIsUsedWithAWarningWhenRec709IsUnknown) {
    const std::string file = write_config(small_config("  scene_linear: working\n", ""));
    shown(DisplayOptions{file, {}, {}, 0}, {0.5f, 0.5f, 0.5f});
    ASSERT_EQ(log_.warnings().size(), 1U);
    EXPECT_NE(log_.warnings()[0].find("'working'"), std::string::npos) << log_.warnings()[0];
}

TEST_F(Display, Rec709IsFoundByItsUsualNames) {
    for (const char* name : {"lin_rec709_scene",
                             "Linear Rec.709 (sRGB)",
                             "lin_rec709",
                             "Utility - Linear - Rec.709",
                             "Linear BT.709"}) {
        const std::string space = std::string("  - !<ColorSpace>\n    name: ") + name +
                                  "\n    to_scene_reference: !<MatrixTransform> {matrix: "
                                  "[0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}\n";
        const std::string file = write_config(small_config("  scene_linear: working\n", space));
        const Rgb out = shown(DisplayOptions{file, {}, {}, 0}, {0.5f, 0.25f, 1});
        EXPECT_NEAR(out[0], 0.25f, 1e-6) << name;
        EXPECT_NEAR(out[2], 0.5f, 1e-6) << name;
    }
    EXPECT_TRUE(log_.warnings().empty());
}

TEST_F(Display, AConfigWithoutAnyLinearSpaceIs78) {
    const Error error =
        error_of(DisplayOptions{write_config(small_config("  default: working\n", "")), {}, {}, 0});
    EXPECT_EQ(error.id, "E-OCIO-FILE");
    EXPECT_NE(error.message.find("scene_linear"), std::string::npos) << error.message;
}

TEST_F(Display, AMissingLookUpTableIs78) {
    const std::string space =
        "  - !<ColorSpace>\n    name: lin_rec709_scene\n"
        "    to_scene_reference: !<FileTransform> {src: absent.cube}\n";
    const Error error = error_of(
        DisplayOptions{write_config(small_config("  scene_linear: working\n", space)), {}, {}, 0});
    EXPECT_EQ(error.id, "E-OCIO-FILE");
    EXPECT_NE(error.message.find("absent.cube"), std::string::npos) << error.message;
}

/// A config whose view shows `out`; `parts` follows the colour spaces.
std::string circle_config(const std::string& out, const std::string& parts) {
    return "ocio_profile_version: 2\nroles: {default: lin, scene_linear: lin}\n"
           "displays:\n  sRGB:\n    - !<View> {name: Film, colorspace: out, looks: soft}\n"
           "colorspaces:\n  - !<ColorSpace> {name: lin}\n  - !<ColorSpace>\n    name: out\n"
           "    from_scene_reference: " +
           out + "\n" + parts;
}

/// OpenColorIO would follow these forever, until the stack overflows.
TEST_F(Display, ReferencesInACircleAre78AndNamed) {
    const std::string look = "looks:\n  - !<Look> {name: soft, process_space: ";
    const std::string plain_look = look + "lin}\n";
    const std::string between =
        "  - !<ColorSpace>\n    name: between\n"
        "    to_scene_reference: !<GroupTransform> {children: [!<ColorSpaceTransform> "
        "{src: out, dst: lin}]}\n";
    struct Case {
        std::string config;
        std::string circle;
    };
    for (const Case& c :
         {Case{circle_config("!<ColorSpaceTransform> {src: lin, dst: out}", plain_look),
               "colour space 'out' -> colour space 'out'"},
          Case{circle_config("!<ColorSpaceTransform> {src: between, dst: lin}",
                             between + plain_look),
               "colour space 'out' -> colour space 'between' -> colour space 'out'"},
          Case{
              circle_config("!<LookTransform> {src: lin, dst: lin, looks: -soft}", look + "out}\n"),
              "colour space 'out' -> look 'soft' -> colour space 'out'"},
          Case{circle_config("!<DisplayViewTransform> {src: lin, display: sRGB, view: Film}",
                             plain_look),
               "view 'Film' of display 'sRGB' -> colour space 'out' -> view 'Film' of display "
               "'sRGB'"},
          Case{circle_config("!<ColorSpaceTransform> {src: lin, dst: $SHOT}", plain_look) +
                   "environment: {SHOT: a$TAKE, TAKE: b$SHOT}\n",
               "variable 'SHOT' -> variable 'TAKE' -> variable 'SHOT'"}}) {
        const Error error = error_of(DisplayOptions{write_config(c.config), {}, {}, 0});
        EXPECT_EQ(error.code, ExitCode::configuration);
        EXPECT_EQ(error.id, "E-OCIO-CYCLE");
        EXPECT_NE(error.message.find(c.circle), std::string::npos) << error.message;
    }
}

/// Not a cycle, but too deep for a stack, or too long for memory.
TEST_F(Display, TowersOfReferencesAre78) {
    for (const bool doubles : {false, true}) {
        std::string tower;
        const int height = doubles ? 40 : 1000;
        for (int i = 1; i <= height; ++i) {
            const std::string below =
                "!<ColorSpaceTransform> {src: lin, dst: " +
                (i == 1 ? std::string("lin") : "step" + std::to_string(i - 1)) + "}";
            tower += "  - !<ColorSpace>\n    name: step" + std::to_string(i) +
                     "\n    from_scene_reference: !<GroupTransform> {children: [" + below +
                     (doubles ? ", " + below : "") + "]}\n";
        }
        const std::string config = circle_config(
            "!<ColorSpaceTransform> {src: lin, dst: step" + std::to_string(height) + "}",
            tower + "looks:\n  - !<Look> {name: soft, process_space: lin}\n");
        EXPECT_EQ(error_of(DisplayOptions{write_config(config), {}, {}, 0}).id, "E-OCIO-CYCLE");
    }
}

struct AcesConfig {
    const char* file;
    int needs_library;  ///< OCIO_VERSION_HEX from which on the file can be read
};

class AcesConfigs : public Display, public testing::WithParamInterface<AcesConfig> {};

TEST_P(AcesConfigs, AgreeWithTheBuiltInConfig) {
    const std::filesystem::path file =
        std::filesystem::path(OBSCURA_SOURCE_DIR) / "../shared/assets/ocio" / GetParam().file;
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file;
    const DisplayOptions options{file.string(), "sRGB - Display", "Un-tone-mapped", 0};
    if (OCIO_VERSION_HEX < GetParam().needs_library) {
        EXPECT_EQ(error_of(options).id, "E-OCIO-FILE") << "made for a newer OpenColorIO";
        return;
    }
    for (const Rgb& in : colors()) {
        const Rgb out = shown(options, in);
        for (size_t i = 0; i < 3; ++i)
            ASSERT_NEAR(out[i], srgb_code(in[i]), 2e-4);
    }
    const DisplayOptions aces{file.string(), {}, "ACES 1.0 - SDR Video", 0};
    const Rgb in{0.4f, 0.2f, 0.1f};
    const Rgb out = shown(aces, in);
    const Rgb expected = shown("ACES 1.0 SDR", in);
    for (size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(out[i], expected[i], 1e-4);
    EXPECT_EQ(error_of(DisplayOptions{file.string(), "sRGB", {}, 0}).id, "E-OCIO-DISPLAY");
    EXPECT_EQ(error_of(DisplayOptions{file.string(), {}, "Filmic", 0}).id, "E-OCIO-VIEW");
    EXPECT_TRUE(log_.warnings().empty());
}

INSTANTIATE_TEST_SUITE_P(
    Shared,
    AcesConfigs,
    testing::Values(AcesConfig{"cg-config-v1.0.0_aces-v1.3_ocio-v2.1.ocio", 0x02010000},
                    AcesConfig{"studio-config-v2.1.0_aces-v1.3_ocio-v2.3.ocio", 0x02030000},
                    AcesConfig{"cg-config-v2.2.0_aces-v1.3_ocio-v2.4.ocio", 0x02040000}),
    [](const auto& config) { return "Config" + std::to_string(config.index); });

}  // namespace
}  // namespace obscura
