// tests/scene/ray_reach_test.cpp - bounds on rays against inverses in double, at many moments.
// SPDX-License-Identifier: Apache-2.0
#include "scene/ray_reach.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include <cmath>
#include <numbers>

namespace obscura {
namespace {

/// Largest value that Embree's assertions accept, in any space.
constexpr double embree_limit = 1.844e18;

Affinef map_of(double x, double y, double z, double tx = 0, double ty = 0, double tz = 0) {
    Affinef out;
    const double scale[] = {x, y, z};
    const double move[] = {tx, ty, tz};
    for (int r = 0; r < 3; ++r) {
        out.m[r][r] = static_cast<float>(scale[r]);
        out.m[r][3] = static_cast<float>(move[r]);
    }
    return out;
}

/// About z, then scaled.
Affinef turned(double angle, double scale = 1) {
    Affinef out = map_of(scale, scale, scale);
    out.m[0][0] = static_cast<float>(scale * std::cos(angle));
    out.m[0][1] = static_cast<float>(-scale * std::sin(angle));
    out.m[1][0] = static_cast<float>(scale * std::sin(angle));
    out.m[1][1] = static_cast<float>(scale * std::cos(angle));
    return out;
}

/// A scene of one instance that is at these positions in turn while the shutter is open.
Scene scene_of(const std::vector<Affinef>& places) {
    Scene scene;
    scene.meshes = {{0, 0}};
    Instance instance;
    instance.world_from_object = places.front();
    if (places.size() > 1) {
        instance.motion = 0;
        scene.motion.steps = static_cast<int32_t>(places.size());
        scene.motion.instances = places;
    }
    scene.instances = {instance};
    scene.bounds = {{-1, -1, -1}, {1, 1, 1}};
    return scene;
}

RayReach reach_of(const std::vector<Affinef>& places) {
    return scene_reach(scene_of(places));
}

TEST(RayReach, ScalesWithTheInstance) {
    EXPECT_EQ(scene_reach(Scene{}).origin, largest_component);
    EXPECT_EQ(scene_reach(Scene{}).direction, largest_component);
    for (const double scale : {1e-11, 1e-3, 1.0}) {
        const RayReach reach = reach_of({map_of(scale, scale, -scale)});
        EXPECT_NEAR(static_cast<double>(reach.origin) / (scale * embree_limit), 0.92, 0.08);
        EXPECT_NEAR(static_cast<double>(reach.direction) / (scale * embree_limit), 0.92, 0.08);
    }
    EXPECT_EQ(reach_of({map_of(1e6, 1e6, 1e6)}).origin, largest_component);
    EXPECT_LT(reach_of({map_of(1e-3, 1, 1)}).origin, 1e-3F * largest_component);
    // A translation uses up a part of it.
    EXPECT_NEAR(reach_of({map_of(1, 1, 1, 0, 1e18)}).origin, 0.95e0 * 1.8e18 - 1e18, 1e16);
    EXPECT_EQ(reach_of({map_of(1, 1, 1, 1.8e18)}).origin, 0.0F);
}

/// Embree divides by a determinant in single precision.
TEST(RayReach, WhatSinglePrecisionCannotInvertHasNone) {
    Affinef skewed = map_of(1, 1, 1);
    skewed.m[0][1] = 1;
    skewed.m[1][0] = 1;
    skewed.m[1][1] = 1 + 1e-7F;
    Affinef lost = map_of(1, 1, 1);
    lost.m[2][2] = NAN;
    for (const Affinef& map : {map_of(1e-13, 1e-13, 1e-13),
                               map_of(1e13, 1e13, 1e13),
                               map_of(0, 1, 1),
                               map_of(1e20, 1e20, 1e-20),
                               skewed,
                               lost}) {
        EXPECT_EQ(reach_of({map}).origin, 0.0F);
        EXPECT_EQ(reach_of({map}).direction, 0.0F);
    }
}

/// Between two times every entry is linear: half a turn passes through a line.
TEST(RayReach, OfMotionIsThatOfItsWorstMoment) {
    EXPECT_EQ(reach_of({turned(0), turned(std::numbers::pi)}).origin, 0.0F);
    EXPECT_EQ(reach_of({turned(0.3), turned(0.3 + std::numbers::pi)}).origin, 0.0F);
    EXPECT_EQ(reach_of({map_of(1, 1, 1), map_of(1, 1, -1)}).origin, 0.0F);
    // 150 degrees: the smallest scale in between is cos(75 degrees).
    const float reach = reach_of({turned(0), turned(std::numbers::pi * 150 / 180)}).origin;
    EXPECT_GT(reach, 0.01F * largest_component);
    EXPECT_LT(reach, 0.26F * largest_component);
    EXPECT_GT(reach_of({turned(0), turned(1), turned(2)}).origin, 0.35F * largest_component);
}

/// Random places and moments: a ray within the reach stays finite by an inverse in double.
TEST(RayReach, HoldsAtEveryMoment) {
    Pcg32 random(5);
    const auto signed_power = [&](double low, double high) {
        const double value = std::pow(10.0, low + (high - low) * random.next_double());
        return random.next_uint() % 2 == 0 ? value : -value;
    };
    int reached = 0;
    for (int round = 0; round < 3000; ++round) {
        const double size = random.next_double() * 12;
        std::vector<Affinef> places(1 + random.next_uint() % 3);
        for (Affinef& place : places) {
            for (auto& row : place.m) {
                for (int c = 0; c < 3; ++c)
                    row[c] = static_cast<float>(signed_power(-size, 8 - size));
                row[3] = static_cast<float>(signed_power(-10, 17));
            }
        }
        const RayReach reach = reach_of(places);
        if (reach.origin == 0 || reach.direction == 0) continue;
        ++reached;
        for (int moment = 0; moment <= 64; ++moment) {
            Affined at = affine_cast<double>(places.front());
            if (places.size() > 1) {
                const size_t step = random.next_uint() % (places.size() - 1);
                for (int r = 0; r < 3; ++r) {
                    for (int c = 0; c < 4; ++c) {
                        at.m[r][c] = static_cast<double>(places[step].m[r][c]) +
                                     (static_cast<double>(places[step + 1].m[r][c]) -
                                      static_cast<double>(places[step].m[r][c])) *
                                         moment / 64;
                    }
                }
            }
            const Affined back = inverse(at);
            for (int axis = 0; axis < 3; ++axis) {
                Vec3d origin{0, 0, 0};
                (axis == 0   ? origin.x
                 : axis == 1 ? origin.y
                             : origin.z) = static_cast<double>(reach.origin);
                EXPECT_LE(max_component(abs(transform_point(back, origin))), embree_limit);
                EXPECT_LE(max_component(abs(transform_point(back, -origin))), embree_limit);
                EXPECT_LE(max_component(abs(transform_vector(back, origin))) *
                              static_cast<double>(reach.direction / reach.origin),
                          embree_limit);
            }
        }
    }
    EXPECT_GT(reached, 800);
}

TEST(RayReach, UnreachedInstancesAreLeftOutOrHalted) {
    Scene scene = scene_of({map_of(1, 1, 1)});
    EXPECT_TRUE(leave_out_unreached(scene).left_out.empty());
    EXPECT_EQ(scene.instances.size(), 1U);

    // The same small instance counts beside a small world, but not beside a large one.
    scene = scene_of({map_of(1e-12, 1e-12, 1e-12)});
    EXPECT_TRUE(leave_out_unreached(scene).left_out.empty());
    scene.bounds.high.x = 1e12F;
    EXPECT_EQ(leave_out_unreached(scene).left_out.size(), 1U);
    EXPECT_TRUE(scene.instances.empty());

    // A camera counts as the world does.
    scene = scene_of({map_of(1e-12, 1e-12, 1e-12)});
    scene.cameras.resize(1);
    scene.cameras[0].world_from_camera.m[1][3] = -1e12;
    EXPECT_EQ(leave_out_unreached(scene).left_out.size(), 1U);

    scene = scene_of({turned(0), turned(std::numbers::pi)});
    const UnreachedInstances unreached = leave_out_unreached(scene);
    EXPECT_TRUE(unreached.left_out.empty());
    EXPECT_EQ(unreached.halted.size(), 1U);
    ASSERT_EQ(scene.instances.size(), 1U);
    EXPECT_FALSE(moves(scene.instances[0]));
}

}  // namespace
}  // namespace obscura
