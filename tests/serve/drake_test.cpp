// tests/serve/drake_test.cpp - Drake's form and query, and what depths and labels become.
// SPDX-License-Identifier: Apache-2.0
#include "serve/drake.h"

#include <gtest/gtest.h>

#include <cmath>
#include <gmock/gmock.h>
#include <limits>

namespace obscura::serve {
namespace {

using testing::HasSubstr;

/// As Drake's client fills it in, numbers with six digits.
Form whole_form() {
    return {{"scene", "{}"},
            {"scene_sha256", std::string(64, 'A')},
            {"image_type", "depth"},
            {"min_depth", "0.100000"},
            {"max_depth", "5.000000"},
            {"width", "640"},
            {"height", "480"},
            {"near", "0.010000"},
            {"far", "10.000000"},
            {"focal_x", "579.411255"},
            {"focal_y", "580.000000"},
            {"fov_x", "1.009095"},
            {"fov_y", "0.784513"},
            {"center_x", "319.500000"},
            {"center_y", "230.250000"},
            {"submit", "Render"}};
}

Result<DrakeRequest> read_with(const std::string& name, const std::string& value) {
    Form form = whole_form();
    form[name] = value;
    return read_drake_form(form);
}

void expect_refused(const Result<DrakeRequest>& got, const std::string& field) {
    ASSERT_FALSE(got) << field;
    EXPECT_EQ(got.error().id, "E-DRAKE-FIELD");
    EXPECT_EQ(got.error().where, field) << got.error().message;
}

TEST(DrakeForm, FieldsBecomeARequest) {
    const Result<DrakeRequest> got = read_drake_form(whole_form());
    ASSERT_TRUE(got) << got.error().message;
    EXPECT_EQ(got->image, DrakeImage::depth);
    EXPECT_EQ(got->sha256, std::string(64, 'a'));
    EXPECT_EQ(got->width, 640);
    EXPECT_EQ(got->height, 480);
    EXPECT_EQ(got->near_m, 0.01);
    EXPECT_EQ(got->far_m, 10);
    EXPECT_EQ(got->depth_range_m, (std::array<double, 2>{0.1, 5}));
    EXPECT_EQ(got->intrinsics.width_px, 640);
    EXPECT_EQ(got->intrinsics.height_px, 480);
    EXPECT_EQ(got->intrinsics.fx_px, 579.411255);
    EXPECT_EQ(got->intrinsics.fy_px, 580);
    EXPECT_EQ(got->intrinsics.cx_px, 319.5);
    EXPECT_EQ(got->intrinsics.cy_px, 230.25);
}

TEST(DrakeForm, EachMissingFieldIsNamed) {
    for (const auto& [name, value] : whole_form()) {
        Form form = whole_form();
        form.erase(name);
        if (name == "submit" || name.starts_with("fov_")) {
            EXPECT_TRUE(read_drake_form(form)) << name;
        } else {
            expect_refused(read_drake_form(form), name);
        }
    }
}

TEST(DrakeForm, OnlyDepthImagesHaveADepthRange) {
    for (const char* type : {"color", "label"}) {
        Form form = whole_form();
        form["image_type"] = type;
        form.erase("min_depth");
        form.erase("max_depth");
        EXPECT_TRUE(read_drake_form(form)) << type;
    }
}

TEST(DrakeForm, ValuesThatCannotBeAreRefusedByName) {
    for (const char* side : {"width", "height"}) {
        for (const char* value : {"", "0", "-4", "65537", "640.0", "1e3", "99999999999", "640 "})
            expect_refused(read_with(side, value), side);
    }
    for (const char* name : {"near", "far", "focal_x", "focal_y", "max_depth"}) {
        for (const char* value : {"", "0", "-1", "nan", "inf", "1e300", "x", "1,5", "0.5m"})
            expect_refused(read_with(name, value), name);
    }
    for (const char* name : {"center_x", "center_y", "min_depth", "fov_x", "fov_y"}) {
        for (const char* value : {"", "nan", "inf", "1e300", "x"})
            expect_refused(read_with(name, value), name);
    }
    expect_refused(read_with("min_depth", "-0.5"), "min_depth");
    expect_refused(read_with("min_depth", "5"), "max_depth");
    expect_refused(read_with("near", "10"), "far");
    expect_refused(read_with("image_type", "Color"), "image_type");
    expect_refused(read_with("scene_sha256", "abc"), "scene_sha256");
    expect_refused(read_with("scene_sha256", std::string(64, 'g')), "scene_sha256");
    Form form = whole_form();
    form["width"] = form["height"] = "65536";
    expect_refused(read_drake_form(form), "width");
}

TEST(DrakeForm, APrincipalPointMayLieOutsideOfTheImage) {
    EXPECT_TRUE(read_with("center_x", "-20.5"));
    EXPECT_TRUE(read_with("center_y", "900"));
}

TEST(DrakeQuery, NamesOptionsOfRender) {
    const auto got = read_drake_query({{"token", "secret"},
                                       {"spp", "32"},
                                       {"env", "studio"},
                                       {"denoise", ""},
                                       {"no-dither", "true"},
                                       {"caustics", "false"}});
    ASSERT_TRUE(got) << got.error().message;
    EXPECT_TRUE(got->z_up);
    EXPECT_EQ(got->labels, LabelEncoding::color);
    EXPECT_EQ(got->options,
              (Options{{"spp", "32"},
                       {"env", "studio"},
                       {"denoise", true},
                       {"no-dither", true},
                       {"caustics", false}}));
}

TEST(DrakeQuery, ChoosesUpAndHowLabelsAreSent) {
    const auto got = read_drake_query({{"up", "y"}, {"labels", "number"}});
    ASSERT_TRUE(got);
    EXPECT_FALSE(got->z_up);
    EXPECT_EQ(got->labels, LabelEncoding::number);
    EXPECT_TRUE(got->options.empty());
}

TEST(DrakeQuery, RefusesWhatTheFormDecidesAndWhatThereIsNot) {
    for (const char* name : {"size", "camera", "eye", "near", "integrator", "sp", "output"}) {
        const auto got = read_drake_query({{name, "1"}});
        ASSERT_FALSE(got) << name;
        EXPECT_EQ(got.error().id, "E-DRAKE-OPTION");
        EXPECT_EQ(got.error().where, name);
        EXPECT_THAT(got.error().message, HasSubstr("spp"));
    }
    EXPECT_FALSE(read_drake_query({{"up", "x"}}));
    EXPECT_FALSE(read_drake_query({{"labels", "both"}}));
}

TEST(DrakeDepth, IsZeroWhereTooNearAndInfiniteWhereTooFar) {
    constexpr float too_far = std::numeric_limits<float>::infinity();
    const std::array<double, 2> range = {0.1, 5};
    EXPECT_EQ(sensed_depth(0, range), too_far);  // nothing is there
    EXPECT_EQ(sensed_depth(0.05f, range), 0);
    EXPECT_EQ(sensed_depth(0.1f, range), 0.1f);
    EXPECT_EQ(sensed_depth(2.5f, range), 2.5f);
    EXPECT_EQ(sensed_depth(5, range), 5);
    EXPECT_EQ(sensed_depth(5.001f, range), too_far);
}

TEST(DrakeLabels, ColorsGiveBackEveryLabel) {
    for (int label = 0; label < 32764; ++label) {
        // As a glTF's text has it, and a float of it.
        const float color[4] = {static_cast<float>((label % 256) / 255.0),
                                static_cast<float>((label / 256) / 255.0),
                                0,
                                1};
        ASSERT_EQ(label_number(label_color(color)), label);
    }
}

}  // namespace
}  // namespace obscura::serve
