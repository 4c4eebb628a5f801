// tests/scene/frame_motion_test.cpp - what moves from frame to frame, and what is left out.
// SPDX-License-Identifier: Apache-2.0
#include "scene/frame_motion.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

Affinef shifted(float x) {
    Affinef out;
    out.m[0][3] = x;
    return out;
}

Instance instance_at(float x, int32_t node) {
    Instance out;
    out.world_from_object = shifted(x);
    out.node = node;
    return out;
}

/// Two triangles of one primitive each, and two instances. `bend` moves the second triangle along
/// y, `step` the second instance along x.
Scene two_and_two(float bend, float step) {
    Scene scene;
    scene.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 5, bend, 0, 6, bend, 0, 5, 1 + bend, 0};
    scene.indices = {0, 1, 2, 3, 4, 5};
    scene.primitives.resize(2);
    for (int32_t i = 0; i < 2; ++i) {
        scene.primitives[static_cast<size_t>(i)].first_triangle = i;
        scene.primitives[static_cast<size_t>(i)].triangle_count = 1;
    }
    scene.instances = {instance_at(0, 7), instance_at(step, 8)};
    scene.cameras.resize(1);
    scene.cameras[0].yfov_rad = 1 + static_cast<double>(step);
    return scene;
}

std::vector<ScenePose> three_poses(float bend, float step) {
    std::vector<ScenePose> out;
    for (const float s : {-1.0F, 0.0F, 1.0F}) {
        Scene scene = two_and_two(0.0F + s * bend, 0.0F + s * step);
        out.push_back(take_pose(scene, {}));
    }
    return out;
}

TEST(FrameMotion, HoldsWhatMovesAlone) {
    FrameMotion motion;
    ASSERT_TRUE(make_frame_motion(two_and_two(0, 0), three_poses(0.25F, 2), motion));
    EXPECT_EQ(motion.vertices[0].base, no_attribute);
    const FrameVertices& bent = motion.vertices[1];
    for (int frame = 0; frame < 3; ++frame) {
        for (int vertex = 3; vertex < 6; ++vertex) {
            const auto word = static_cast<size_t>(bent.base + frame * bent.stride + 3 * vertex);
            const float own = vertex == 5 ? 1.0F : 0.0F;
            EXPECT_EQ(motion.positions[word + 1], own + 0.25F * static_cast<float>(frame - 1));
        }
    }
    EXPECT_EQ(motion.instance, (std::vector<int32_t>{-1, 0}));
    ASSERT_EQ(motion.instances.size(), 3U);
    EXPECT_EQ(motion.instances[0].m[0][3], -2);
    EXPECT_EQ(motion.instances[2].m[0][3], 2);
    EXPECT_EQ(motion.cameras[2][0].yfov_rad, 3);
}

TEST(FrameMotion, IsEmptyWhereNothingMoves) {
    FrameMotion motion;
    ASSERT_TRUE(make_frame_motion(two_and_two(0, 0), three_poses(0, 0), motion));
    EXPECT_TRUE(motion.positions.empty());
    EXPECT_TRUE(motion.instances.empty());
}

TEST(FrameMotion, OfOtherPartsIsThatOfTheCameraAlone) {
    std::vector<ScenePose> poses = three_poses(0.25F, 2);
    poses[2].instances.pop_back();
    FrameMotion motion;
    EXPECT_FALSE(make_frame_motion(two_and_two(0, 0), poses, motion));
    EXPECT_TRUE(motion.positions.empty());
    EXPECT_EQ(motion.instance, (std::vector<int32_t>{-1, -1}));
    EXPECT_EQ(motion.cameras[0][0].yfov_rad, -1);
}

TEST(FrameMotion, FollowsTheInstancesThatAreKept) {
    const std::vector<Instance> before = {
        instance_at(0, 1), instance_at(0, 2), instance_at(5, 2), instance_at(5, 3)};
    FrameMotion motion;
    motion.instance = {0, 3, -1, 6};
    leave_out_frames(before, {before[1], before[3]}, motion);
    EXPECT_EQ(motion.instance, (std::vector<int32_t>{3, 6}));
}

}  // namespace
}  // namespace obscura
