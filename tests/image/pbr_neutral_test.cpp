// tests/image/pbr_neutral_test.cpp - the Khronos PBR Neutral curve against its specification.
// SPDX-License-Identifier: Apache-2.0
#include "image/pbr_neutral.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace obscura {
namespace {

using Rgb = std::array<double, 3>;

Rgb mapped(Rgb rgb) {
    tone_map_pbr_neutral(rgb.data());
    return rgb;
}

TEST(PbrNeutral, BaseColoursStayButForTheFresnelReflection) {
    // Above 0.08 and below the highlights the curve only takes 0.04 away.
    for (const Rgb& in : {Rgb{0.1, 0.4, 0.7}, Rgb{0.79, 0.09, 0.5}, Rgb{0.2, 0.2, 0.2}}) {
        const Rgb out = mapped(in);
        for (size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(out[i], in[i] - 0.04, 1e-15);
    }
    // Below it takes x - x^2 / 0.16 of the smallest value x.
    const Rgb dark = mapped({0.04, 0.3, 0.05});
    EXPECT_NEAR(dark[0], 0.01, 1e-15);
    EXPECT_NEAR(dark[1], 0.27, 1e-15);
    EXPECT_NEAR(dark[2], 0.02, 1e-15);
    EXPECT_EQ(mapped({0, 0, 0}), (Rgb{0, 0, 0}));
}

TEST(PbrNeutral, KnownHighlight) {
    // Grey 1.04: p = 1; p_n = 1 - 0.24^2 / 0.48 = 0.88; a grey stays grey: p_n.
    const Rgb grey = mapped({1.04, 1.04, 1.04});
    for (const double value : grey)
        EXPECT_NEAR(value, 0.88, 1e-12);
    // Red 1.04, others 0.04: offset 0.03; p = 1.01, p_n = 1 - 0.0576 / 0.49;
    // g = 1 / (0.15 (p - p_n) + 1); red becomes p_n, the others 0.01 p_n / p g + p_n (1 - g).
    const double p = 1.01;
    const double p_n = 1 - 0.0576 / 0.49;
    const double g = 1 / (0.15 * (p - p_n) + 1);
    const Rgb red = mapped({1.04, 0.04, 0.04});
    EXPECT_NEAR(red[0], p_n, 1e-12);
    EXPECT_NEAR(red[1], 0.01 * p_n / p * g + p_n * (1 - g), 1e-12);
    EXPECT_EQ(red[1], red[2]);
}

TEST(PbrNeutral, ContinuousMonotoneAndBelowOne) {
    for (const Rgb& hue : {Rgb{1, 1, 1}, Rgb{1, 0.2, 0}, Rgb{0.3, 0.9, 0.6}}) {
        double before = -1;
        for (double level = 0; level < 1000; level = level * 1.002 + 1e-5) {
            const Rgb out = mapped({hue[0] * level, hue[1] * level, hue[2] * level});
            const double largest = std::max({out[0], out[1], out[2]});
            ASSERT_GE(largest, before) << level;
            ASSERT_LT(largest, 1.0);
            ASSERT_GE(std::min({out[0], out[1], out[2]}), 0.0);
            ASSERT_TRUE(before < 0 || largest - before < 0.003) << level;
            before = largest;
        }
    }
}

TEST(PbrNeutral, FloatAgreesWithDouble) {
    for (double level = 0; level < 50; level = level * 1.1 + 1e-3) {
        Rgb exact{level, level * 0.3, level * 0.6};
        float rgb[3] = {static_cast<float>(exact[0]),
                        static_cast<float>(exact[1]),
                        static_cast<float>(exact[2])};
        tone_map_pbr_neutral(exact.data());
        tone_map_pbr_neutral(rgb);
        for (size_t i = 0; i < 3; ++i)
            ASSERT_NEAR(rgb[i], exact[i], 1e-6) << level;
    }
}

}  // namespace
}  // namespace obscura
