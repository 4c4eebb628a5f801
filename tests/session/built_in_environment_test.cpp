// tests/session/built_in_environment_test.cpp - environments by name.
// SPDX-License-Identifier: Apache-2.0
#include "session/built_in_environment.h"

#include <gtest/gtest.h>

#include <cmath>

namespace obscura {
namespace {

TEST(BuiltInEnvironment, NamesAreNotFiles) {
    using Kind = BuiltInEnvironmentKind;
    EXPECT_EQ(parse_built_in_environment("studio").value()->kind, Kind::studio);
    EXPECT_EQ(parse_built_in_environment("neutral").value()->kind, Kind::neutral);
    EXPECT_EQ(parse_built_in_environment("white").value()->kind, Kind::white);
    for (const char* file : {"./studio", "studio.hdr", "Studio", "", "./sky", "sky.exr"})
        EXPECT_FALSE(parse_built_in_environment(file).value()) << file;
    const BuiltInEnvironment sky = *parse_built_in_environment("sky:12.5,-30").value();
    EXPECT_EQ(sky.kind, Kind::sky);
    EXPECT_EQ(sky.elevation_deg, 12.5);
    EXPECT_EQ(sky.azimuth_deg, -30);
}

TEST(BuiltInEnvironment, TheAnglesOfASkyAreChecked) {
    for (const char* text :
         {"sky", "sky:", "sky:10", "sky:10,", "sky:a,b", "sky:1,2,3", "sky:nan,0x"})
        EXPECT_EQ(parse_built_in_environment(text).error().id, "E-USAGE-NUMBER") << text;
    for (const char* text : {"sky:-1,0", "sky:91,0", "sky:10,1e9", "sky:nan,0"})
        EXPECT_EQ(parse_built_in_environment(text).error().id, "E-USAGE-RANGE") << text;
}

/// Mean of the red channel over the sphere.
double mean(const ImageRgb32f& image) {
    double sum = 0;
    double weights = 0;
    for (size_t i = 0; i < image.pixels.size(); i += 3) {
        const auto y = static_cast<double>(i / 3 / static_cast<size_t>(image.width));
        const double weight = std::sin(M_PI * (y + 0.5) / image.height);
        sum += weight * static_cast<double>(image.pixels[i]);
        weights += weight;
    }
    return sum / weights;
}

TEST(BuiltInEnvironment, PlainOnesAreOneInTheMean) {
    using Kind = BuiltInEnvironmentKind;
    const ImageRgb32f white = make_built_in_environment({Kind::white});
    for (const float value : white.pixels)
        EXPECT_EQ(value, 1);
    const ImageRgb32f neutral = make_built_in_environment({Kind::neutral});
    EXPECT_NEAR(mean(neutral), 1, 1e-6);
    EXPECT_GT(neutral.pixels.front(), 1.2F);
    EXPECT_LT(neutral.pixels.back(), 0.8F);
    EXPECT_EQ(neutral.pixels.size(),
              size_t{3} * static_cast<size_t>(neutral.width) * static_cast<size_t>(neutral.height));
    EXPECT_EQ(make_built_in_environment({Kind::sky, 40, 0}).width, 2048);
    EXPECT_EQ(make_built_in_environment({}).width, 256);
}

}  // namespace
}  // namespace obscura
