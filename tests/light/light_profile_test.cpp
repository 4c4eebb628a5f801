// tests/light/light_profile_test.cpp - measured lamps: interpolation, axes, lumens, lanes.
// SPDX-License-Identifier: Apache-2.0
#include "light/light_profile.h"

#include "light/punctual_lanes.h"
#include "light/punctual_sample.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace obscura {
namespace {

constexpr double degree = pi_d / 180;

/// Uneven angles and no symmetry; dark beyond 120 degrees.
LightProfile uneven_profile() {
    LightProfile profile;
    profile.polar_deg = {0, 5, 20, 50, 90, 120};
    profile.azimuth_deg = {0, 30, 100, 200, 330, 360};
    for (size_t plane = 0; plane < 6; ++plane) {
        for (size_t i = 0; i < 6; ++i) {
            const size_t around =
                i == 0 ? 0 : plane % 5;  // one value at the pole, and at 0 and 360
            profile.candela.push_back(static_cast<float>(100 + 17 * around * i + 3 * i * i));
        }
    }
    return profile;
}

/// Aimed down, the zero axis along +X: as in EXT_lights_ies after a rotation of -90 degrees about
/// X.
ProfileAxes<double> lamp_axes() {
    return {{0, -1, 0}, {1, 0, 0}};
}

Vec3d lamp_direction(double polar_deg, double azimuth_deg) {
    const ProfileAxes<double> axes = lamp_axes();
    const Vec3d third = cross(axes.zero, axes.polar);
    const double sine = std::sin(polar_deg * degree);
    return axes.polar * std::cos(polar_deg * degree) +
           (axes.zero * std::cos(azimuth_deg * degree) + third * std::sin(azimuth_deg * degree)) *
               sine;
}

double candela(const LightProfile& profile, double polar_deg, double azimuth_deg) {
    const LightProfileTable table = pack_light_profiles({&profile, 1});
    return profile_candela<double>(
        table.view(), 0, lamp_axes(), lamp_direction(polar_deg, azimuth_deg));
}

double value(const LightProfile& profile, size_t plane, size_t i) {
    return static_cast<double>(profile.candela[plane * profile.polar_deg.size() + i]);
}

TEST(LightProfile, MeetsTheTableAndIsBilinearBetween) {
    const LightProfile profile = uneven_profile();
    EXPECT_NEAR(candela(profile, 20, 100), value(profile, 2, 2), 1e-10);
    EXPECT_NEAR(candela(profile, 0, 0), 100, 1e-10);
    const double low = 0.75 * value(profile, 3, 3) + 0.25 * value(profile, 4, 3);
    const double high = 0.75 * value(profile, 3, 4) + 0.25 * value(profile, 4, 4);
    EXPECT_NEAR(candela(profile, 70, 232.5), 0.5 * (low + high), 1e-9);
    EXPECT_NEAR(candela(profile, 119.999, 40), candela(profile, 120, 40), 0.01);
    EXPECT_EQ(candela(profile, 121, 40), 0);
    EXPECT_EQ(candela(profile, 180, 40), 0);
}

/// Illuminance of the ground under a lamp, from the definition of luminous intensity.
TEST(LightProfile, LightsThePlaneBelowByTheCubeOfTheCosine) {
    const LightProfile profile = uneven_profile();
    const LightProfileTable table = pack_light_profiles({&profile, 1});
    PunctualLight lamp;
    lamp.profile = 0;
    lamp.position[1] = 2.5F;
    const ProfileAxes<double> axes = lamp_axes();
    lamp.direction[1] = -1;
    lamp.direction[2] = 0;
    lamp.intensity[1] = 0.5F;
    const double height = 2.5;
    for (const double polar : {3.0, 12.5, 35.0, 66.0, 84.0}) {
        for (const double azimuth : {0.0, 17.0, 65.0, 150.0, 265.0, 345.0}) {
            const Vec3d away = lamp_direction(polar, azimuth);
            const Vec3d place = Vec3d{0, height, 0} + away * (height / dot(away, axes.polar));
            ASSERT_NEAR(place.y, 0, 1e-12);
            const auto s = sample_punctual<double>(&lamp, 0, place, table.view());
            const double cosine = std::cos(polar * degree);
            const double expected =
                candela(profile, polar, azimuth) * cosine * cosine * cosine / (height * height);
            EXPECT_NEAR(s.irradiance.x * s.direction.y, expected, 1e-9 * expected);
            EXPECT_NEAR(s.irradiance.y * s.direction.y, 0.5 * expected, 1e-9 * expected);
        }
    }
}

TEST(LightProfile, OnePlaneIsTheSameAllAround) {
    LightProfile profile;
    profile.polar_deg = {0, 90};
    profile.azimuth_deg = {0};
    profile.candela = {200, 100};
    for (const double azimuth : {-170.0, 0.0, 45.0, 300.0})
        EXPECT_NEAR(candela(profile, 45, azimuth), 150, 1e-9);
}

TEST(LightProfile, LumensAreTheIntegralOverAllDirections) {
    LightProfile even;
    even.polar_deg = {0, 60, 180};
    even.azimuth_deg = {0};
    even.candela = {3, 3, 3};
    EXPECT_NEAR(profile_lumens(even), 12 * pi_d, 1e-12);

    const LightProfile profile = uneven_profile();
    double sum = 0;
    constexpr int rows = 720;
    constexpr int columns = 720;
    const LightProfileTable table = pack_light_profiles({&profile, 1});
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            const double polar = 180.0 * (y + 0.5) / rows;
            const Vec3d d = lamp_direction(polar, 360.0 * (x + 0.5) / columns);
            sum +=
                profile_candela<double>(table.view(), 0, lamp_axes(), d) * std::sin(polar * degree);
        }
    }
    sum *= pi_d / rows * 2 * pi_d / columns;
    EXPECT_NEAR(profile_lumens(profile) / sum, 1, 1e-5);
}

TEST(LightProfile, FloatDoubleAndLanesAgree) {
    LightProfile around;
    around.polar_deg = {0, 45, 180};
    around.azimuth_deg = {0};
    around.candela = {10, 30, 20};
    const std::array<LightProfile, 2> profiles = {uneven_profile(), around};
    const LightProfileTable table = pack_light_profiles(profiles);
    PunctualLight lights[3];
    lights[0].profile = 0;
    lights[1].intensity[0] = 40;  // no profile
    lights[2].profile = 1;
    test::expect_lanes_agree(lights, table.view(), 1e-4);
}

TEST(LightProfile, StaysFiniteAtTheLampAndOnItsAxis) {
    const LightProfile profile = uneven_profile();
    const LightProfileTable table = pack_light_profiles({&profile, 1});
    PunctualLight lamp;
    lamp.profile = 0;
    for (const Vec3f& from :
         {Vec3f{0, 0, 0}, Vec3f{0, 0, -1}, Vec3f{0, 0, 1}, Vec3f{0, 0, 1e15F}}) {
        const auto s = sample_punctual<float>(&lamp, 0, from, table.view());
        EXPECT_TRUE(std::isfinite(s.irradiance.x) && s.irradiance.x >= 0);
    }
    EXPECT_EQ(LightProfileTable().view().records, nullptr);
}

}  // namespace
}  // namespace obscura
