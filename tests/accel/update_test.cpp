// tests/accel/update_test.cpp - an updated hierarchy equals one built for the later pose alone.
// SPDX-License-Identifier: Apache-2.0
#include "accel/accel.h"
#include "accel/accel_scenes.h"

#include <gtest/gtest.h>

#include <gmock/gmock.h>

namespace obscura {
namespace {

using namespace test;

/// Geometry shared by poses: a static ball, and a ball in a mesh, 3 m from it at the start.
Scene two_balls(GeometryStamp still, GeometryStamp mesh) {
    SceneBuilder builder;
    const int32_t material = builder.material({});
    builder.sphere({0, 0, 0}, 1, 12, material);
    builder.sphere({3, 0, 0}, 1, 12, material);
    Scene scene = builder.take();
    scene.world_primitive_count = scene.static_primitive_count = 1;
    scene.static_stamp = still;
    scene.meshes = {{1, 1, mesh}};
    return scene;
}

/// The mesh's ball moves up.
void place(Scene& scene, float up) {
    Instance instance;
    instance.world_from_object.m[1][3] = up;
    instance.object_from_world.m[1][3] = -up;
    scene.instances = {instance};
}

RayList rays_down() {
    RayList rays;
    Pcg32 random(1);
    for (int i = 0; i < 500; ++i) {
        const float x = between(random, -2, 5);
        rays.add({x, between(random, -3, 3), 10}, {0, 0, -1});
    }
    return rays;
}

void expect_same_hits(const Accel& a, const Accel& b) {
    RayList p = rays_down();
    RayList q = rays_down();
    for (const Coherence coherence : both_ways) {
        p.intersect(a, coherence);
        q.intersect(b, coherence);
        EXPECT_EQ(p.primitive, q.primitive);
        EXPECT_EQ(p.instance, q.instance);
        for (int i = 0; i < p.count(); ++i) {
            if (!p.hit(i)) continue;
            EXPECT_EQ(p.triangle[static_cast<size_t>(i)], q.triangle[static_cast<size_t>(i)]) << i;
        }
        EXPECT_EQ(p.t, q.t);
        p.occlude(a, coherence);
        q.occlude(b, coherence);
        EXPECT_EQ(p.occluded, q.occluded);
    }
    EXPECT_THAT(p.primitive, testing::Contains(0));
}

TEST(Update, ALaterPoseHasTheHitsOfThePoseAlone) {
    const GeometryStamp still = new_geometry_stamp();
    const GeometryStamp mesh = new_geometry_stamp();
    Scene scene = two_balls(still, mesh);
    place(scene, 0);
    auto accel = Accel::build(scene, "");
    ASSERT_TRUE(accel);
    for (const float up : {1.0F, -0.5F}) {
        place(scene, up);
        ASSERT_TRUE(accel->update(scene));
        Scene alone = two_balls(0, 0);
        place(alone, up);
        expect_same_hits(*accel, build(std::move(alone)).accel);
    }
    scene.instances.clear();
    ASSERT_TRUE(accel->update(scene));
    RayList rays = rays_down();
    rays.intersect(*accel, Coherence::coherent);
    EXPECT_THAT(rays.primitive, testing::Not(testing::Contains(1)));
}

/// Static geometry in a hierarchy of its own gives the hits of one hierarchy.
TEST(Update, WhatStandsStillIsHitAsInTheWorld) {
    Scene apart = two_balls(0, 0);
    place(apart, 0);
    Scene together = two_balls(0, 0);
    place(together, 0);
    together.static_primitive_count = 0;
    const BuiltScene one = build(std::move(apart));
    const BuiltScene other = build(std::move(together));
    expect_same_hits(one.accel, other.accel);
}

/// Changed vertices with an old stamp are not noticed: that is what stamps are for.
TEST(Update, AStampStandsForTheVertices) {
    Scene scene = two_balls(new_geometry_stamp(), new_geometry_stamp());
    place(scene, 0);
    auto accel = Accel::build(scene, "");
    ASSERT_TRUE(accel);
    const auto hits_static = [&] {
        RayList rays;
        rays.add({0, 0, 10}, {0, 0, -1});
        rays.intersect(*accel, Coherence::incoherent);
        return rays.hit(0);
    };
    EXPECT_TRUE(hits_static());
    const size_t ball = scene.positions.size() / 2 - 2;
    for (size_t i = 0; i < ball; i += 3)
        scene.positions[i] += 100;
    scene.static_stamp = new_geometry_stamp();
    ASSERT_TRUE(accel->update(scene));
    EXPECT_FALSE(hits_static());
}

/// A material that becomes see-through gives its geometry a filter.
TEST(Update, AlphaThatComesIsSeen) {
    Scene scene = two_balls(new_geometry_stamp(), new_geometry_stamp());
    place(scene, 0);
    scene.materials[0].flags = material_alpha_blend;
    auto accel = Accel::build(scene, "");
    ASSERT_TRUE(accel);
    const auto hits = [&] {
        RayList rays;
        rays.add({0, 0, 10}, {0, 0, -1});
        rays.add({3, 0, 10}, {0, 0, -1});
        rays.intersect(*accel, Coherence::incoherent);
        return std::pair(rays.hit(0), rays.hit(1));
    };
    EXPECT_EQ(hits(), std::pair(true, true));
    scene.materials[0].base_color[3] = 0;
    ASSERT_TRUE(accel->update(scene));
    EXPECT_EQ(hits(), std::pair(false, false));
    scene.materials[0].base_color[3] = 1;
    ASSERT_TRUE(accel->update(scene));
    EXPECT_EQ(hits(), std::pair(true, true));
}

}  // namespace
}  // namespace obscura
