// tests/truth/placed_thin_walls_test.cpp - thin walls that are instances or move, and lamps.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/thin_wall_scenes.h"

namespace obscura::test {
namespace placed_thin_walls_truth {

/// A level pane at a height of 2, under which the floor is lit by `light`.
ThinWallScene under_pane(const PunctualLight& light) {
    ThinWallScene scene;
    scene.light(light);
    scene.pane(2, scene.add(glass_material(), glass_layers()));
    return scene;
}

Scene with_placed_pane(const PunctualLight& light, const std::vector<Affinef>& places) {
    Scene scene = under_pane(light).take();
    place_last(scene, places);
    return scene;
}

const Affinef there;

TEST(PlacedThinWalls, InstancesLetPassWhatTheMeshDoes) {
    for (const PunctualLight& light : {lamp_at({6, 8, 0}), slanting_sun()}) {
        const double expected = floor_value(under_pane(light).take());
        ASSERT_GT(expected, 0.01);
        for (const Affinef& place : {there,
                                     placing({2, 1, 3}, {0, 1, 0}),
                                     placing({1, -1, 1}, {0, 4.5f, 0}),
                                     placing({-0.5f, 1, 1}, {0, -0.5f, 0})}) {
            for (const Integrator i : {Integrator::path, Integrator::raycast}) {
                ThinWallView view;
                view.integrator = i;
                EXPECT_NEAR(
                    floor_value(with_placed_pane(light, {place}), view), expected, 1e-5 * expected);
            }
        }
    }
}

/// A rising pane transmits as much at any height; a rotating one as its own angle says.
TEST(PlacedThinWalls, MovingOnesDoSoAtEveryTime) {
    const PunctualLight light = slanting_sun();
    const double expected = floor_value(under_pane(light).take());
    const std::vector<Affinef> rising = {
        there, placing({1, 1, 1}, {0, 1, 0}), placing({1, 1, 1}, {3, 5, 0})};
    EXPECT_NEAR(
        floor_value(with_placed_pane(light, rising), {.samples = 64}), expected, 1e-5 * expected);

    // Sheared from level towards (0, 1, -s): the sun stands in the plane x y, so that only the
    // normal's length and its y count.
    Affinef sheared;
    sheared.m[1][2] = 1;
    const double open = [&] {
        ThinWallScene scene;
        scene.light(light);
        return floor_value(scene.take());
    }();
    double mean = 0;
    constexpr int parts = 1000;
    for (int i = 0; i < parts; ++i) {
        const double s = (i + 0.5) / parts;
        mean += pane_lets_pass(0.8 / std::hypot(1, s)) / parts;
    }
    EXPECT_NEAR(floor_value(with_placed_pane(light, {there, sheared}), {.samples = 1024}) / open,
                mean,
                2e-4);
}

/// Half of the time the pane is outside of the light's path.
TEST(PlacedThinWalls, ThoseThatComeAndGoCountForTheirTime) {
    const PunctualLight light = slanting_sun();
    const double covered = floor_value(under_pane(light).take());
    const double open = covered / pane_lets_pass(0.8);
    // At height 2 the floor's light comes by x = 1.5, where the pane's edge is at one half.
    const std::vector<Affinef> leaving = {there, placing({1, 1, 1}, {203, 0, 0})};
    EXPECT_NEAR(floor_value(with_placed_pane(light, leaving), {.samples = 4096}),
                0.5 * (covered + open),
                2e-3 * open);
}

TEST(PlacedThinWalls, MeasuredLampsShineThroughThem) {
    PunctualLight lamp = lamp_at({3, 4, 0});
    lamp.profile = 0;
    lamp.direction[0] = 0;
    lamp.direction[1] = -1;
    lamp.direction[2] = 0;
    LightProfile profile;  // brighter aside than below
    profile.polar_deg = {0, 90};
    profile.azimuth_deg = {0, 360};
    profile.candela = {100, 1000, 100, 1000};
    const auto lit = [&](bool pane) {
        ThinWallScene walls;
        walls.light(lamp);
        if (pane) walls.pane(2, walls.add(glass_material(), glass_layers()));
        Scene scene = walls.take();
        scene.light_profiles = {profile};
        return floor_value(scene);
    };
    const double open = lit(false);
    ASSERT_GT(open, 0.1);
    EXPECT_NEAR(lit(true) / open, pane_lets_pass(0.8), 1e-5);
}

}  // namespace placed_thin_walls_truth
}  // namespace obscura::test
