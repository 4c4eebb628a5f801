// tests/light/punctual_sample_test.cpp - KHR_lights_punctual against the extension's formulas.
// SPDX-License-Identifier: Apache-2.0
#include "light/punctual_sample.h"

#include "light/punctual_lanes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace obscura {
namespace {

PunctualLight point_light() {
    PunctualLight light;
    light.position[1] = 3;
    light.intensity[0] = 18;
    light.intensity[1] = 9;
    return light;
}

/// The extension's definition, from the two cone angles.
PunctualLight spot_light(double inner_rad, double outer_rad) {
    PunctualLight light = point_light();
    light.type = static_cast<int32_t>(PunctualType::spot);
    light.direction[1] = -1;
    light.direction[2] = 0;
    const double scale = 1 / (std::cos(inner_rad) - std::cos(outer_rad));
    light.spot_scale = static_cast<float>(scale);
    light.spot_on_axis = static_cast<float>((1 - std::cos(outer_rad)) * scale);
    return light;
}

template <typename F>
PunctualSample<F> at(const PunctualLight& light, const Vec3<F>& from) {
    return sample_punctual<F>(&light, 0, from);
}

TEST(PunctualSample, PointFollowsTheInverseSquare) {
    const auto below = at<double>(point_light(), {0, 0, 0});
    EXPECT_DOUBLE_EQ(below.irradiance.x, 2);
    EXPECT_DOUBLE_EQ(below.irradiance.y, 1);
    EXPECT_DOUBLE_EQ(below.distance, 3);
    EXPECT_DOUBLE_EQ(below.direction.y, 1);
    EXPECT_DOUBLE_EQ(at<double>(point_light(), {4, 0, 0}).irradiance.x, 18.0 / 25);
}

TEST(PunctualSample, RangeWindowEndsTheLight) {
    PunctualLight light = point_light();
    light.range = 6;
    const double half = 1 - std::pow(0.5, 4);
    EXPECT_NEAR(at<double>(light, {0, 0, 0}).irradiance.x, 2 * half, 1e-12);
    EXPECT_EQ(at<double>(light, {0, -3, 0}).irradiance.x, 0);
    EXPECT_EQ(at<double>(light, {0, -300, 0}).irradiance.x, 0);
}

TEST(PunctualSample, SpotFallsOffBetweenItsAngles) {
    const PunctualLight light = spot_light(0.2, 0.6);
    const auto share = [&](double angle) {
        const Vec3d from{3 * std::tan(angle), 0, 0};
        const auto s = at<double>(light, from);
        return s.irradiance.x * s.distance * s.distance / 18;
    };
    EXPECT_NEAR(share(0), 1, 1e-6);
    EXPECT_NEAR(share(0.19), 1, 1e-6);
    const double t = (std::cos(0.4) - std::cos(0.6)) / (std::cos(0.2) - std::cos(0.6));
    EXPECT_NEAR(share(0.4), t * t, 1e-6);
    EXPECT_EQ(share(0.61), 0);
    EXPECT_EQ(at<double>(light, {0, 6, 0}).irradiance.x, 0);  // behind it
}

TEST(PunctualSample, NarrowSpotsKeepTheirDigitsInFloat) {
    for (const double outer : {0.03, 0.003, 0.0005}) {
        const PunctualLight light = spot_light(0, outer);
        const auto share = [&](double angle) {
            const auto s = at<float>(light, {static_cast<float>(3 * std::tan(angle)), 0, 0});
            return s.irradiance.x * s.distance * s.distance / 18;
        };
        EXPECT_NEAR(share(0), 1, 1e-5) << outer;
        EXPECT_NEAR(share(outer / 2), 0.75 * 0.75, 1e-3) << outer;
        EXPECT_NEAR(share(outer * 1.001), 0, 1e-5) << outer;
    }
}

TEST(PunctualSample, DirectionalIsTheSameEverywhere) {
    PunctualLight light = point_light();
    light.type = static_cast<int32_t>(PunctualType::directional);
    light.range = 1;
    for (const float x : {0.0F, 1e6F, -1e15F}) {
        const auto s = at<float>(light, {x, 0, 0});
        EXPECT_EQ(s.irradiance.x, 18);
        EXPECT_EQ(s.direction.z, 1);
        EXPECT_EQ(s.distance, directional_distance_m);
        EXPECT_TRUE(std::isfinite(s.direction.x));
    }
}

TEST(PunctualSample, StaysFiniteAtTheLightAndFarAway) {
    for (const PunctualLight& light : {point_light(), spot_light(0.1, 0.2)}) {
        for (const Vec3f& from : {Vec3f{0, 3, 0}, Vec3f{0, 3, 1e-12F}, Vec3f{0, -1e15F, 0}}) {
            const auto s = at<float>(light, from);
            EXPECT_TRUE(std::isfinite(s.irradiance.x) && s.irradiance.x >= 0);
            EXPECT_TRUE(std::isfinite(s.direction.x + s.direction.y + s.direction.z));
        }
    }
}

TEST(PunctualSample, FloatDoubleAndLanesAgree) {
    PunctualLight lights[3] = {point_light(), spot_light(0.3, 1.2), point_light()};
    lights[0].range = 8;
    lights[2].type = static_cast<int32_t>(PunctualType::directional);
    test::expect_lanes_agree(lights, {}, 2e-5);
}

}  // namespace
}  // namespace obscura
