// tests/app/numbers_test.cpp - numbers on the command line are read strictly.
// SPDX-License-Identifier: Apache-2.0
#include "app/numbers.h"

#include <gtest/gtest.h>

#include <gmock/gmock.h>

namespace obscura::app {
namespace {

using testing::HasSubstr;

template <typename T>
void expect_refused(const Result<T>& result, const char* id, const char* accepted) {
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ExitCode::usage);
    EXPECT_EQ(result.error().id, id);
    EXPECT_THAT(result.error().where, HasSubstr("--it"));
    EXPECT_THAT(result.error().message, HasSubstr(accepted));
}

TEST(Numbers, IntegersInRangeAreRead) {
    EXPECT_EQ(parse_integer("64", "--it", 1, 100), 64);
    EXPECT_EQ(parse_integer("+7", "--it", 1, 100), 7);
    EXPECT_EQ(parse_integer("-3", "--it", -5, 5), -3);
    EXPECT_EQ(parse_unsigned("18446744073709551615", "--it"), 18446744073709551615U);
}

TEST(Numbers, IntegersWithAnythingElseAreRefused) {
    for (const char* text :
         {"", " 1", "1 ", "1x", "0x10", "1.0", "1e3", "one", "--1", "+-1", "1,0"}) {
        SCOPED_TRACE(text);
        expect_refused(parse_integer(text, "--it", 0, 100), "E-USAGE-NUMBER", "0 to 100");
    }
    for (const char* text : {"-1", "101", "99999999999999999999"}) {
        SCOPED_TRACE(text);
        expect_refused(parse_integer(text, "--it", 0, 100), "E-USAGE-RANGE", "0 to 100");
    }
    expect_refused(parse_unsigned("18446744073709551616", "--it"), "E-USAGE-RANGE", "from 0");
    expect_refused(parse_unsigned("-1", "--it"), "E-USAGE-NUMBER", "from 0");
}

TEST(Numbers, RealsAreFiniteAndWhole) {
    EXPECT_EQ(parse_real("1.5", "--it", -9, 9), 1.5);
    EXPECT_EQ(parse_real("-2e-1", "--it", -9, 9), -0.2);
    for (const char* text : {"", "nan", "1.5x", "1,5", "1..5", "e5", "0x1p3"}) {
        SCOPED_TRACE(text);
        expect_refused(parse_real(text, "--it", -9, 9), "E-USAGE-NUMBER", "-9 to 9");
    }
    for (const char* text : {"inf", "-inf", "1e999", "9.001"}) {
        SCOPED_TRACE(text);
        expect_refused(parse_real(text, "--it", -9, 9), "E-USAGE-RANGE", "-9 to 9");
    }
}

TEST(Numbers, LengthsHaveAUnit) {
    for (const char* text : {"0.01", "0.01m", "1e-2m"}) {
        const Result<ParsedLength> metres = parse_length(text, "--it");
        ASSERT_TRUE(metres) << text;
        EXPECT_EQ(metres->value, 0.01);
        EXPECT_FALSE(metres->pixels);
    }
    const Result<ParsedLength> pixels = parse_length("2.5px", "--it");
    ASSERT_TRUE(pixels);
    EXPECT_EQ(pixels->value, 2.5);
    EXPECT_TRUE(pixels->pixels);
    for (const char* text : {"", "m", "px", "3 px", "3pt", "3cm", "3mm", "nan", "3pxm"}) {
        SCOPED_TRACE(text);
        expect_refused(parse_length(text, "--it"), "E-USAGE-NUMBER", "such as 3px");
    }
    for (const char* text : {"0", "-1px", "0px", "1001px", "1e10m", "1e999"}) {
        SCOPED_TRACE(text);
        expect_refused(parse_length(text, "--it"), "E-USAGE-RANGE", "such as 0.01 or 0.01m");
    }
}

TEST(Numbers, Sizes) {
    const Result<std::array<int, 2>> good = parse_size("1280x720", "--it");
    ASSERT_TRUE(good);
    EXPECT_EQ((*good)[0], 1280);
    EXPECT_EQ((*good)[1], 720);
    EXPECT_TRUE(parse_size("65536x8192", "--it"));
    for (const char* text : {"1280", "x", "1280x", "x720", "1280X720", "1x2x3", "a x b", "8 x 8"}) {
        SCOPED_TRACE(text);
        expect_refused(parse_size(text, "--it"), "E-USAGE-NUMBER", "1280x720");
    }
    for (const char* text : {"0x5", "5x-1", "65537x1", "99999999999x1", "65536x65536"}) {
        SCOPED_TRACE(text);
        expect_refused(parse_size(text, "--it"), "E-USAGE-RANGE", "536870912");
    }
}

TEST(Numbers, PointsColorsRectangles) {
    const Result<Vec3d> point = parse_point("-1,2.5,3e2", "--it");
    ASSERT_TRUE(point);
    EXPECT_EQ(point->x, -1);
    EXPECT_EQ(point->y, 2.5);
    EXPECT_EQ(point->z, 300);
    expect_refused(parse_point("1,2", "--it"), "E-USAGE-NUMBER", "x,y,z");
    expect_refused(parse_point("1,2,3,", "--it"), "E-USAGE-NUMBER", "x,y,z");
    expect_refused(parse_point("1,nan,3", "--it"), "E-USAGE-RANGE", "x,y,z");
    expect_refused(parse_point("1,2,1e19", "--it"), "E-USAGE-RANGE", "x,y,z");
    EXPECT_TRUE(parse_color("0,0.5,2", "--it"));
    expect_refused(parse_color("0,-0.5,2", "--it"), "E-USAGE-RANGE", "transparent");
    expect_refused(parse_color("sky", "--it"), "E-USAGE-NUMBER", "transparent");
    EXPECT_EQ(*parse_color("white", "--it"), (std::array<float, 3>{1, 1, 1}));
    EXPECT_EQ(*parse_color("black", "--it"), (std::array<float, 3>{0, 0, 0}));
    const std::array<float, 3> grey = *parse_color("gray", "--it");
    EXPECT_EQ(grey, *parse_color("grey", "--it"));
    EXPECT_EQ(grey, *parse_color("#808080", "--it"));
    EXPECT_NEAR(grey[0], 0.2158605f, 1e-6f) << "linear";
    const std::array<float, 3> page = *parse_page("#0080fF", "--it");
    EXPECT_FLOAT_EQ(page[0], 0);
    EXPECT_FLOAT_EQ(page[1], 128.0f / 255) << "encoded";
    EXPECT_FLOAT_EQ(page[2], 1);
    EXPECT_EQ(*parse_page("0,0.5,1", "--it"), (std::array<float, 3>{0, 0.5f, 1}));
    expect_refused(parse_page("0,0.5,1.1", "--it"), "E-USAGE-RANGE", "from 0 to 1");
    for (const char* text : {"#12345", "#12345g", "#+12345", "#1234567", "White", "transparent"})
        expect_refused(parse_page(text, "--it"), "E-USAGE-NUMBER", "#RRGGBB");
    EXPECT_TRUE(parse_rectangle("0,0,1,1", "--it"));
    expect_refused(parse_rectangle("0,0,0,1", "--it"), "E-USAGE-RANGE", "X,Y");
    expect_refused(parse_rectangle("-1,0,1,1", "--it"), "E-USAGE-RANGE", "X,Y");
    expect_refused(parse_rectangle("0,0,1", "--it"), "E-USAGE-NUMBER", "X,Y");
}

TEST(Numbers, IndicesAreDigitsOnly) {
    EXPECT_TRUE(is_index("0"));
    EXPECT_TRUE(is_index("12"));
    for (const char* text : {"", "-1", "+1", "1a", " 1"})
        EXPECT_FALSE(is_index(text)) << text;
}

}  // namespace
}  // namespace obscura::app
