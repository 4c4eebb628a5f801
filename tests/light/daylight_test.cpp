// tests/light/daylight_test.cpp - the clear sky and its sun.
// SPDX-License-Identifier: Apache-2.0
#include "light/daylight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace obscura {
namespace {

constexpr double degree = M_PI / 180;

struct Sums {
    std::array<double, 3> ground = {};  ///< irradiance of a horizontal plane from above
    std::array<double, 3> facing = {};  ///< where the brightest pixel is: x, y, z
    double brightest = 0;
};

Sums sums_of(const std::vector<float>& pixels) {
    Sums out;
    for (int y = 0; y < daylight_height; ++y) {
        const double theta = M_PI * (y + 0.5) / daylight_height;
        const double solid_angle =
            2 * M_PI / daylight_width * M_PI / daylight_height * std::sin(theta);
        for (int x = 0; x < daylight_width; ++x) {
            const float* rgb =
                &pixels[3 * (static_cast<size_t>(y) * daylight_width + static_cast<size_t>(x))];
            for (size_t c = 0; c < 3; ++c) {
                EXPECT_TRUE(rgb[c] >= 0 && std::isfinite(rgb[c]));
                if (y < daylight_height / 2)
                    out.ground[c] += static_cast<double>(rgb[c]) * std::cos(theta) * solid_angle;
            }
            if (static_cast<double>(rgb[1]) <= out.brightest) continue;
            out.brightest = static_cast<double>(rgb[1]);
            const double phi = 2 * M_PI * ((x + 0.5) / daylight_width - 0.5);
            out.facing = {
                std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
        }
    }
    return out;
}

double luminance(const std::array<double, 3>& rgb) {
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

TEST(Daylight, LightsTheGroundAlikeAtAllTimes) {
    for (const double elevation : {2.0, 10.0, 45.0, 90.0}) {
        const Sums sums = sums_of(make_daylight_pixels(elevation * degree, 0.5));
        EXPECT_NEAR(luminance(sums.ground) / M_PI, daylight_ground, 0.01) << elevation;
    }
}

TEST(Daylight, TheSunIsWhereItIsAskedFor) {
    const Sums sums = sums_of(make_daylight_pixels(30 * degree, 90 * degree));
    EXPECT_NEAR(sums.facing[0], std::cos(30 * degree), 5e-3);
    EXPECT_NEAR(sums.facing[1], 0.5, 5e-3);
    EXPECT_NEAR(sums.facing[2], 0, 5e-3);
    EXPECT_NEAR(
        sums_of(make_daylight_pixels(30 * degree, 0)).facing[2], std::cos(30 * degree), 5e-3);
}

TEST(Daylight, TheSunGivesMostLightAndIsSmall) {
    const std::vector<float> pixels = make_daylight_pixels(45 * degree, 0);
    size_t bright = 0;
    for (size_t i = 1; i < pixels.size(); i += 3)
        bright += pixels[i] > 100 ? 1 : 0;
    EXPECT_GE(bright, 4U);  // 0.53 degrees are three pixels across
    EXPECT_LE(bright, 40U);
}

TEST(Daylight, NoonsSkyIsBlueAndTheLowSunIsRed) {
    const std::vector<float> noon = make_daylight_pixels(60 * degree, 0);
    const size_t away = 3 * (size_t{400} * daylight_width + daylight_width / 4);  // from -Z
    EXPECT_GT(noon[away + 2], 1.2F * noon[away]);
    const std::vector<float> evening = make_daylight_pixels(3 * degree, 0);
    const auto brightest = std::max_element(evening.begin(), evening.end()) - evening.begin();
    const size_t pixel = static_cast<size_t>(brightest) / 3 * 3;
    EXPECT_GT(evening[pixel], 2 * evening[pixel + 2]);
}

}  // namespace
}  // namespace obscura
