// tests/scene/texel_colors_test.cpp - converted texels against the curve and the matrix in double.
// SPDX-License-Identifier: Apache-2.0
#include "scene/texel_colors.h"

#include "surface/texture.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace obscura {
namespace {

constexpr Matrix3 mixing = {{{0.6, 0.3, 0.1}, {0.05, 0.9, 0.05}, {0.02, 0.11, 0.87}}};

/// IEC 61966-2-1:1999, section 5.2
double linear_light(double code) {
    return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

std::vector<uint32_t> some_texels() {
    std::vector<uint32_t> out = {0xFF000000U, 0x00FFFFFFU, 0x800000FFU, 0xFF00FF00U, 0x7FFF0000U};
    for (uint32_t i = 0; i < 20000; ++i)
        out.push_back(i * 2654435761U);
    return out;
}

TEST(TexelColors, AreTheMatrixTimesLinearLight) {
    const std::vector<uint32_t> before = some_texels();
    std::vector<uint32_t> high = before, low = before;
    convert_texels(mixing, high.data(), low.data(), high.size());
    const MaskOf<float> srgb = true;
    for (size_t i = 0; i < before.size(); ++i) {
        const Rgba<float> found = decode_wide_texel<float>(high[i], low[i], srgb);
        std::array<double, 3> rgb = {};
        for (size_t c = 0; c < 3; ++c)
            rgb[c] = linear_light((before[i] >> (8 * c) & 255U) / 255.0);
        const float values[3] = {found.rgb.x, found.rgb.y, found.rgb.z};
        for (size_t c = 0; c < 3; ++c) {
            const double expected =
                mixing[c][0] * rgb[0] + mixing[c][1] * rgb[1] + mixing[c][2] * rgb[2];
            // Half of one of 65535 steps, where the curve is steepest.
            ASSERT_NEAR(values[c], expected, 2e-5) << i;
        }
        ASSERT_EQ(found.alpha, static_cast<float>((before[i] >> 24) * 257U) * (1.0f / 65535.0f));
    }
}

TEST(TexelColors, WhatNeedsNoConversionKeepsItsCodes) {
    constexpr Matrix3 same = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    const std::vector<uint32_t> before = some_texels();
    std::vector<uint32_t> high = before, low = before;
    for (uint32_t& word : low)
        word ^= 0x005A3C17U;
    const std::vector<uint32_t> low_before = low;
    convert_texels(same, high.data(), low.data(), high.size());
    size_t different = 0;
    for (size_t i = 0; i < before.size(); ++i)
        different += high[i] != before[i] || low[i] != low_before[i] ? 1 : 0;
    EXPECT_LT(different, before.size() / 50) << "single precision is on an edge now and then";
}

}  // namespace
}  // namespace obscura
