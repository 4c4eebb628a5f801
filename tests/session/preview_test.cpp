// tests/session/preview_test.cpp - AOVs become readable 8-bit images.
// SPDX-License-Identifier: Apache-2.0
#include "session/preview.h"

#include <gtest/gtest.h>

#include <cmath>

namespace obscura {
namespace {

OutputImage image_of(std::vector<std::string> channels, UnsetArray<float> pixels) {
    OutputImage image;
    image.width = static_cast<int>(pixels.size() / channels.size());
    image.height = 1;
    image.channels = std::move(channels);
    image.pixels = std::move(pixels);
    return image;
}

TEST(Preview, NormalsMapToTheUnitCube) {
    const OutputImage out = preview_image(
        image_of({"N.X", "N.Y", "N.Z"}, {0, 0, 1, -1, 0, 0, 0, 0, 0}), Integrator::normal);
    EXPECT_EQ(out.channels, (std::vector<std::string>{"R", "G", "B"}));
    EXPECT_EQ(out.pixels, (UnsetArray<float>{0.5f, 0.5f, 1, 0, 0.5f, 0.5f, 0, 0, 0}));
}

TEST(Preview, DepthGoesFromNearWhiteToFarDark) {
    const OutputImage out =
        preview_image(image_of({"Z"}, {2, 6, 4, 0, INFINITY, NAN}), Integrator::depth);
    EXPECT_FLOAT_EQ(out.pixels[0], 1);
    EXPECT_FLOAT_EQ(out.pixels[3], 0.15f);
    EXPECT_FLOAT_EQ(out.pixels[6], 0.575f);
    for (size_t i = 3; i < 6; ++i)
        EXPECT_EQ(out.pixels[3 * i], 0) << "nothing is there";
    const OutputImage flat = preview_image(image_of({"Z"}, {3, 3}), Integrator::depth);
    EXPECT_FLOAT_EQ(flat.pixels[0], 1);
}

TEST(Preview, IdsGetTheirOwnColors) {
    const OutputImage out = preview_image(
        image_of({"node", "material", "triangle"}, {0, 0, 0, 1, 1, 1, 1, 1, 2, 1, 1, 1}),
        Integrator::id);
    const auto color = [&](size_t i) {
        return std::vector<float>(out.pixels.begin() + static_cast<long>(3 * i),
                                  out.pixels.begin() + static_cast<long>(3 * i + 3));
    };
    EXPECT_EQ(color(0), (std::vector<float>{0, 0, 0}));
    EXPECT_NE(color(1), color(2));
    EXPECT_EQ(color(1), color(3));
    for (const float value : color(1))
        EXPECT_GE(value, 0.2f);
}

TEST(Preview, ColorsFollowTheSrgbCurve) {
    const OutputImage albedo =
        preview_image(image_of({"R", "G", "B", "A"}, {0.2140411f, 1, 0, 0.5f}), Integrator::albedo);
    EXPECT_NEAR(albedo.pixels[0], 0.5f, 1e-4f);
    EXPECT_NEAR(albedo.pixels[1], 1, 1e-6f);
    EXPECT_EQ(albedo.pixels[2], 0);
    const OutputImage ao = preview_image(image_of({"AO"}, {0.2140411f, 7}), Integrator::ao);
    EXPECT_NEAR(ao.pixels[2], 0.5f, 1e-4f);
    EXPECT_NEAR(ao.pixels[5], 1, 1e-6f);
}

TEST(Preview, UvShowsItsFractions) {
    const OutputImage out =
        preview_image(image_of({"UV.U", "UV.V"}, {0.25f, 3.5f, -0.25f, 1}), Integrator::uv);
    EXPECT_EQ(out.pixels, (UnsetArray<float>{0.25f, 0.5f, 0, 0.75f, 0, 0}));
}

TEST(Preview, HeatGlowsAndFewHotPixelsDoNotDarkenTheRest) {
    UnsetArray<float> tests;
    for (int i = 0; i < 300; ++i)
        tests.push_back(static_cast<float>(i % 31));
    tests.push_back(1000);
    const OutputImage out = preview_image(image_of({"heat"}, tests), Integrator::heat);
    EXPECT_EQ(out.pixels[0], 0);
    EXPECT_FLOAT_EQ(out.pixels[3 * 10], 1) << "a third is red";
    EXPECT_FLOAT_EQ(out.pixels[3 * 10 + 1], 0);
    EXPECT_FLOAT_EQ(out.pixels[3 * 15 + 1], 0.5f);
    EXPECT_FLOAT_EQ(out.pixels[3 * 30 + 2], 1) << "white";
    EXPECT_FLOAT_EQ(out.pixels[3 * 300 + 2], 1);
}

TEST(Preview, DistanceLooksLikeDepthAndFacingLikeGrey) {
    const UnsetArray<float> values = {2, 6, 4};
    EXPECT_EQ(preview_image(image_of({"distance"}, values), Integrator::distance).pixels,
              preview_image(image_of({"Z"}, values), Integrator::depth).pixels);
    const OutputImage facing =
        preview_image(image_of({"facing"}, {0.2140411f}), Integrator::facing);
    EXPECT_NEAR(facing.pixels[1], 0.5f, 1e-4f);
}

TEST(Preview, LightNeedsNone) {
    for (const Integrator light : {Integrator::path, Integrator::direct, Integrator::raycast})
        EXPECT_FALSE(needs_preview(light));
    EXPECT_TRUE(needs_preview(Integrator::ao));
    EXPECT_TRUE(needs_preview(Integrator::wireframe));
}

}  // namespace
}  // namespace obscura
