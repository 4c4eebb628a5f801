// tests/image/rendering_space_test.cpp - spaces by name and by config, against published matrices.
// SPDX-License-Identifier: Apache-2.0
#include "image/rendering_space.h"

#include "base/setting_names.h"
#include "image/test_images.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <gmock/gmock.h>

namespace obscura {
namespace {

using testing::HasSubstr;

class RenderingSpaces : public testing_images::FolderTest {
protected:
    void SetUp() override {
        FolderTest::SetUp();
        ::unsetenv("OCIO");
    }

    RenderingSpace space(const std::string& name, const std::string& file = "") {
        const Result<RenderingSpace> found = find_rendering_space(name, file, log_);
        EXPECT_TRUE(found) << name << ": " << found.error().message;
        return found.value_or(RenderingSpace{});
    }
    Error error_of(const std::string& name, const std::string& file = "") {
        const Result<RenderingSpace> found = find_rendering_space(name, file, log_);
        EXPECT_FALSE(found) << name;
        return found ? Error{} : found.error();
    }

    /// A config whose space "wide" is this matrix times Rec.709, and "bent" is a power of it.
    std::string config_with(const std::string& matrix) {
        const std::filesystem::path file = folder_ / "config.ocio";
        std::ofstream(file) << R"(ocio_profile_version: 2
strictparsing: true
roles: {default: lin_rec709_scene, scene_linear: lin_rec709_scene}
file_rules:
  - !<Rule> {name: Default, colorspace: default}
displays:
  screen:
    - !<View> {name: plain, colorspace: lin_rec709_scene}
colorspaces:
  - !<ColorSpace> {name: lin_rec709_scene}
  - !<ColorSpace>
    name: wide
    from_scene_reference: !<MatrixTransform> {matrix: [)"
                            << matrix << R"(]}
  - !<ColorSpace>
    name: bent
    from_scene_reference: !<ExponentTransform> {value: [2, 2, 2, 1]}
)";
        return file.string();
    }

    Log log_{Verbosity::quiet};
};

struct Published {
    const char* name;
    const char* id;
    Matrix3 matrix;
};

/// ACES: colour-science 0.4, Bradford from D65. Rec.2020: ITU-R BT.2087-0, table 2.
const Published published_spaces[] = {
    {"acescg",
     "lin_ap1_scene",
     {{{0.6131, 0.3395, 0.0474}, {0.0702, 0.9164, 0.0135}, {0.0206, 0.1096, 0.8698}}}},
    {"aces2065-1",
     "lin_ap0_scene",
     {{{0.4396, 0.3830, 0.1774}, {0.0898, 0.8134, 0.0968}, {0.0175, 0.1115, 0.8709}}}},
    {"lin_rec2020",
     "lin_rec2020_scene",
     {{{0.6274, 0.3293, 0.0433}, {0.0691, 0.9195, 0.0114}, {0.0164, 0.0880, 0.8956}}}}};

TEST_F(RenderingSpaces, HaveThePublishedMatrices) {
    for (const Published& expected : published_spaces) {
        SCOPED_TRACE(expected.name);
        const RenderingSpace found = space(expected.name);
        EXPECT_EQ(found.interop_id, expected.id);
        ASSERT_TRUE(found.from_rec709);
        for (size_t row = 0; row < 3; ++row) {
            for (size_t column = 0; column < 3; ++column)
                EXPECT_NEAR((*found.from_rec709)[row][column], expected.matrix[row][column], 1e-4);
        }
        float white[3] = {1, 1, 1};
        convert_colors(*found.from_rec709, white);
        for (const float value : white)
            EXPECT_NEAR(value, 1, 1e-6);
    }
    EXPECT_FALSE(space("lin_rec709").from_rec709) << "the default converts nothing";
}

/// OpenColorIO's own transforms come to the same matrices.
TEST_F(RenderingSpaces, OfTheBuiltInConfigAreRecognised) {
    EXPECT_EQ(space("ACEScg").interop_id, "lin_ap1_scene");
    EXPECT_EQ(space("lin_ap1").interop_id, "lin_ap1_scene");
    EXPECT_EQ(space("ACES2065-1").interop_id, "lin_ap0_scene");
    EXPECT_EQ(space("Linear Rec.709").interop_id, "lin_rec709_scene");
    EXPECT_FALSE(space("Linear Rec.709").from_rec709);
}

TEST_F(RenderingSpaces, OfAnotherConfigHaveTheirPrimaries) {
    const std::string file =
        config_with("0.5, 0.3, 0.2, 0, 0.1, 0.8, 0.1, 0, 0, 0.25, 0.75, 0, 0, 0, 0, 1");
    const RenderingSpace wide = space("wide", file);
    EXPECT_EQ(wide.interop_id, "") << "nobody has given it one";
    ASSERT_TRUE(wide.from_rec709);
    EXPECT_NEAR((*wide.from_rec709)[0][1], 0.3, 1e-6);
    // Its primaries make the same light of white as those of Rec.709 do.
    const Xyz white = product(xyz_from_rgb(wide.primaries, wide.white), Xyz{1, 1, 1});
    const Xyz expected = white_xyz(d65);
    const Xyz red = product(xyz_from_rgb(wide.primaries, wide.white), Xyz{0.5, 0.1, 0});
    const Xyz rec709_red = product(xyz_from_rgb(rec709_primaries), Xyz{1, 0, 0});
    for (size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(white[c], expected[c], 1e-5);
        EXPECT_NEAR(red[c], rec709_red[c], 1e-5);
    }
}

TEST_F(RenderingSpaces, OthersAreRefused) {
    const auto refused = [&](const char* name, const std::string& file, const char* message) {
        const Error error = error_of(name, file);
        EXPECT_EQ(error.id, "E-OCIO-SPACE") << name;
        EXPECT_EQ(error.code, ExitCode::configuration);
        EXPECT_THAT(error.message, HasSubstr(message));
    };
    refused("acescc", "", "known are lin_rec709, acescg, aces2065-1, lin_rec2020");
    refused("acescc", "", "'ACEScg'");
    refused("sRGB Encoded Rec.709", "", "not linear");
    refused("Raw", "", "no colour space");
    const std::string narrow =
        config_with("1.2, -0.1, -0.1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1");
    refused("wide", narrow, "does not hold all colours of Rec.709");
    refused("bent", narrow, "not linear");
    const std::string bright = config_with("2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1");
    refused("wide", bright, "another white");
    EXPECT_EQ(error_of("wide", (folder_ / "none.ocio").string()).id, "E-OCIO-FILE");
}

}  // namespace
}  // namespace obscura
