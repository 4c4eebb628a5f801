// tests/gltf/animation_test.cpp - interpolated keyframes against closed forms in double.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/animation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <gmock/gmock.h>

namespace obscura::gltf {
namespace {

using testing::DoubleNear;
using testing::Pointwise;
using Values = std::vector<double>;

Keyframes line(Interpolation interpolation) {
    return {{interpolation, 2, false}, {1, 2, 4}, {0, 10, 4, 30, -4, 30}};
}

TEST(Sample, LinearIsTheLineBetweenKeys) {
    const Keyframes keys = line(Interpolation::linear);
    EXPECT_EQ(sample(keys, 1.25), (Values{1, 15}));
    EXPECT_EQ(sample(keys, 3), (Values{0, 30}));
    EXPECT_EQ(sample(keys, 2), (Values{4, 30}));
}

TEST(Sample, StepKeepsTheLastKey) {
    const Keyframes keys = line(Interpolation::step);
    EXPECT_EQ(sample(keys, 1.999), (Values{0, 10}));
    EXPECT_EQ(sample(keys, 2), (Values{4, 30}));
    EXPECT_EQ(sample(keys, 3.999), (Values{4, 30}));
}

TEST(Sample, OutsideTheKeysItStandsStill) {
    for (const Interpolation interpolation : {Interpolation::linear, Interpolation::step}) {
        const Keyframes keys = line(interpolation);
        EXPECT_EQ(sample(keys, -5), (Values{0, 10}));
        EXPECT_EQ(sample(keys, 100), (Values{-4, 30}));
    }
}

/// 1/24 as a float is a little more than 1/24: the frame must see the key all the same.
TEST(Sample, AFramesTimeMeetsTheKeyWrittenForIt) {
    for (int frame = 1; frame < 100; ++frame) {
        const double time_s = frame / 24.0;
        Keyframes keys{{Interpolation::step, 1, false}, {0, static_cast<float>(time_s)}, {0, 1}};
        EXPECT_EQ(sample(keys, time_s)[0], 1) << frame;
        keys.kind.interpolation = Interpolation::linear;
        EXPECT_EQ(sample(keys, time_s)[0], 1) << frame;
    }
}

TEST(Sample, OfEqualTimesTheLaterKeyCounts) {
    const Keyframes keys{{Interpolation::linear, 1, false}, {0, 1, 1, 2}, {0, 1, 5, 6}};
    EXPECT_EQ(sample(keys, 1)[0], 5);
    EXPECT_EQ(sample(keys, 1.5)[0], 5.5);
    EXPECT_EQ(sample(keys, 0.5)[0], 0.5);
}

/// A cubic and its derivative at the keys give that cubic everywhere.
TEST(Sample, CubicSplineIsTheCubicThroughItsTangents) {
    const auto f = [](double t) { return 2 * t * t * t - 3 * t * t + t - 7; };
    const auto slope = [](double t) { return 6 * t * t - 6 * t + 1; };
    Keyframes keys;
    keys.kind.interpolation = Interpolation::cubic_spline;
    for (const double t : {0.0, 0.5, 2.0, 3.0}) {
        keys.times.push_back(static_cast<float>(t));
        for (const double value : {slope(t), f(t), slope(t)})
            keys.values.push_back(static_cast<float>(value));
    }
    for (double t = 0; t <= 3; t += 0.07)
        EXPECT_NEAR(sample(keys, t)[0], f(t), 1e-12) << t;
    EXPECT_EQ(sample(keys, -1)[0], f(0));
    EXPECT_EQ(sample(keys, 9)[0], f(3));
}

/// A rotation about a unit axis.
std::array<double, 4> about(const std::array<double, 3>& axis, double angle) {
    const double s = std::sin(0.5 * angle);
    return {axis[0] * s, axis[1] * s, axis[2] * s, std::cos(0.5 * angle)};
}

TEST(Slerp, TurnsAtAConstantRate) {
    const std::array<double, 3> axis = {2.0 / 7, 3.0 / 7, -6.0 / 7};
    for (const double angle : {1e-9, 1e-5, 0.01, 1.0, 3.0}) {
        for (const double fraction : {0.0, 0.1, 0.5, 0.75, 1.0}) {
            const auto got = slerp(about(axis, 0.4), about(axis, 0.4 + angle), fraction);
            EXPECT_THAT(got, Pointwise(DoubleNear(1e-15), about(axis, 0.4 + fraction * angle)))
                << angle << " " << fraction;
        }
    }
}

TEST(Slerp, TakesTheShortWay) {
    const std::array<double, 3> axis = {0, 1, 0};
    auto end = about(axis, 1.0);
    for (double& component : end)
        component = -component;  // the same turn
    EXPECT_THAT(slerp(about(axis, 0), end, 0.25), Pointwise(DoubleNear(1e-15), about(axis, 0.25)));
}

TEST(Sample, QuaternionsAreTurnedAndUnit) {
    Keyframes keys{{Interpolation::linear, 4, true}, {0, 1}, {0, 0, 0, 2, 0, 0, 3, 3}};
    const double eighth = 3.14159265358979323846 / 8;
    EXPECT_THAT(sample(keys, 0.5),
                Pointwise(DoubleNear(1e-15), Values{0, 0, std::sin(eighth), std::cos(eighth)}));
    keys.kind.interpolation = Interpolation::step;
    EXPECT_EQ(sample(keys, 0.5), (Values{0, 0, 0, 1}));
    keys.kind.interpolation = Interpolation::cubic_spline;  // tangents 0: the mean, made unit
    keys.values = {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0};
    const double half = std::sqrt(0.5);
    EXPECT_THAT(sample(keys, 0.5), Pointwise(DoubleNear(1e-15), Values{0, 0, half, half}));
}

}  // namespace
}  // namespace obscura::gltf
