// tests/surface/srgb_test.cpp - the sRGB tables and formulas against the standard in double.
// SPDX-License-Identifier: Apache-2.0
#include "surface/srgb.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace obscura {
namespace {

double true_linear(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double true_encoded(double linear) {
    return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

TEST(Srgb, TableHoldsTheNearestFloatOfEveryCode) {
    for (int code = 0; code < 256; ++code) {
        EXPECT_FLOAT_EQ(srgb_to_linear_table[code], static_cast<float>(true_linear(code / 255.0)))
            << "code " << code;
    }
    EXPECT_EQ(srgb_to_linear_table[0], 0.0f);
    EXPECT_EQ(srgb_to_linear_table[255], 1.0f);
}

TEST(Srgb, FormulaFollowsTheStandardAndInverts) {
    for (int i = 0; i <= 1000; ++i) {
        const auto x = static_cast<float>(i) / 1000.0f;
        EXPECT_NEAR(linear_from_srgb(x), true_linear(x), 1e-7) << x;
        EXPECT_NEAR(srgb_from_linear(x), true_encoded(x), 1e-7) << x;
        EXPECT_NEAR(srgb_from_linear(linear_from_srgb(x)), x, 3e-7) << x;
    }
    EXPECT_FLOAT_EQ(linear_from_srgb(-0.1f), -0.1f / 12.92f);
    EXPECT_NEAR(srgb_from_linear(4.0f), true_encoded(4.0), 1e-6);
}

TEST(Srgb, EightBitEncodingReturnsEveryCode) {
    for (int code = 0; code < 256; ++code) {
        EXPECT_EQ(srgb8_from_linear(srgb_to_linear_table[code]), code);
    }
}

TEST(Srgb, EightBitEncodingIsTheNearestCode) {
    for (int i = 0; i <= 1 << 20; ++i) {
        const float linear = static_cast<float>(i) / static_cast<float>(1 << 20);
        const double exact = true_encoded(linear) * 255.0;
        ASSERT_LE(std::fabs(srgb8_from_linear(linear) - exact), 0.5 + 1e-4) << linear;
    }
}

TEST(Srgb, EightBitEncodingSwitchesExactlyAtTheMiddleBetweenCodes) {
    for (int code = 1; code < 256; ++code) {
        const double middle = true_linear((code - 0.5) / 255.0);
        EXPECT_EQ(srgb8_from_linear(static_cast<float>(middle * (1.0 - 1e-6))), code - 1);
        EXPECT_EQ(srgb8_from_linear(static_cast<float>(middle * (1.0 + 1e-6))), code);
    }
}

TEST(Srgb, EightBitEncodingClampsWhatIsOutside) {
    EXPECT_EQ(srgb8_from_linear(-1.0f), 0);
    EXPECT_EQ(srgb8_from_linear(1e30f), 255);
    EXPECT_EQ(srgb8_from_linear(std::numeric_limits<float>::infinity()), 255);
    EXPECT_EQ(srgb8_from_linear(std::numeric_limits<float>::quiet_NaN()), 0);
}

}  // namespace
}  // namespace obscura
