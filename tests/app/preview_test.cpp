// tests/app/preview_test.cpp - quantities become readable 8-bit pictures.
// SPDX-License-Identifier: Apache-2.0
#include "app/preview.h"

#include <gtest/gtest.h>

#include <cmath>

namespace obscura {
namespace {

Picture picture_of(std::vector<std::string> channels, UnsetArray<float> pixels) {
    Picture picture;
    picture.width = static_cast<int>(pixels.size() / channels.size());
    picture.height = 1;
    picture.channels = std::move(channels);
    picture.pixels = std::move(pixels);
    return picture;
}

TEST(Preview, NormalsMapToTheUnitCube) {
    const Picture out = preview_picture(
        picture_of({"N.X", "N.Y", "N.Z"}, {0, 0, 1, -1, 0, 0, 0, 0, 0}), Integrator::normal);
    EXPECT_EQ(out.channels, (std::vector<std::string>{"R", "G", "B"}));
    EXPECT_EQ(out.pixels, (UnsetArray<float>{0.5f, 0.5f, 1, 0, 0.5f, 0.5f, 0, 0, 0}));
}

TEST(Preview, DepthGoesFromNearWhiteToFarDark) {
    const Picture out =
        preview_picture(picture_of({"Z"}, {2, 6, 4, 0, INFINITY, NAN}), Integrator::depth);
    EXPECT_FLOAT_EQ(out.pixels[0], 1);
    EXPECT_FLOAT_EQ(out.pixels[3], 0.15f);
    EXPECT_FLOAT_EQ(out.pixels[6], 0.575f);
    for (size_t i = 3; i < 6; ++i)
        EXPECT_EQ(out.pixels[3 * i], 0) << "nothing is there";
    const Picture flat = preview_picture(picture_of({"Z"}, {3, 3}), Integrator::depth);
    EXPECT_FLOAT_EQ(flat.pixels[0], 1);
}

TEST(Preview, IdsGetTheirOwnColors) {
    const Picture out = preview_picture(
        picture_of({"node", "material", "triangle"}, {0, 0, 0, 1, 1, 1, 1, 1, 2, 1, 1, 1}),
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
    const Picture albedo = preview_picture(
        picture_of({"R", "G", "B", "A"}, {0.2140411f, 1, 0, 0.5f}), Integrator::albedo);
    EXPECT_NEAR(albedo.pixels[0], 0.5f, 1e-4f);
    EXPECT_NEAR(albedo.pixels[1], 1, 1e-6f);
    EXPECT_EQ(albedo.pixels[2], 0);
    const Picture ao = preview_picture(picture_of({"AO"}, {0.2140411f, 7}), Integrator::ao);
    EXPECT_NEAR(ao.pixels[2], 0.5f, 1e-4f);
    EXPECT_NEAR(ao.pixels[5], 1, 1e-6f);
}

TEST(Preview, QuantitiesAreTold) {
    for (const Integrator light : {Integrator::path, Integrator::direct}) {
        EXPECT_FALSE(needs_preview(light));
        EXPECT_FALSE(is_quantity(light));
    }
    EXPECT_TRUE(needs_preview(Integrator::ao));
    EXPECT_FALSE(is_quantity(Integrator::ao));
    EXPECT_TRUE(is_quantity(Integrator::depth));
}

}  // namespace
}  // namespace obscura
