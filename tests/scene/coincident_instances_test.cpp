// tests/scene/coincident_instances_test.cpp - coinciding copies are found among other instances.
// SPDX-License-Identifier: Apache-2.0
#include "scene/coincident_instances.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

Instance at(float x, int32_t mesh = 0, int32_t node = 0) {
    Instance out;
    out.world_from_object.m[0][3] = x;
    out.mesh = mesh;
    out.node = node;
    return out;
}

std::vector<int32_t> nodes_of(const std::vector<Instance>& instances) {
    std::vector<int32_t> out;
    for (const Instance& instance : instances)
        out.push_back(instance.node);
    return out;
}

TEST(CoincidentInstances, AFewStayAsTheyAre) {
    Scene scene;
    for (uint32_t i = 0; i < max_copies; ++i)
        scene.instances.push_back(at(7));
    EXPECT_TRUE(leave_out_copies(scene).empty());
    EXPECT_EQ(scene.instances.size(), max_copies);
    scene.instances.push_back(at(7));
    EXPECT_EQ(leave_out_copies(scene).size(), max_copies);
    EXPECT_EQ(scene.instances.size(), 1U);
}

TEST(CoincidentInstances, TheFirstOfEachCrowdStaysInItsPlace) {
    Scene scene;
    for (int32_t i = 0; i < 100; ++i) {
        scene.instances.push_back(at(static_cast<float>(i), 0, i));  // alone
        scene.instances.push_back(at(-1, 0, 1000 + i));
        scene.instances.push_back(at(-1, 1, 2000 + i));  // another mesh there
    }
    const std::vector<Instance> copies = leave_out_copies(scene);
    EXPECT_EQ(copies.size(), 198U);
    const std::vector<int32_t> kept = nodes_of(scene.instances);
    ASSERT_EQ(kept.size(), 102U);
    EXPECT_EQ(kept[0], 0);
    EXPECT_EQ(kept[1], 1000);
    EXPECT_EQ(kept[2], 2000);
    for (size_t i = 3; i < kept.size(); ++i)
        EXPECT_EQ(kept[i], static_cast<int32_t>(i) - 2);
}

/// Instances in one position now may separate while the shutter is open.
TEST(CoincidentInstances, CopiesMoveAlike) {
    Scene scene;
    scene.motion.steps = 2;
    for (int32_t i = 0; i < 60; ++i) {
        Instance instance = at(3, 0, i);
        instance.motion = static_cast<int32_t>(scene.motion.instances.size());
        scene.motion.instances.push_back(instance.world_from_object);
        const float later = i % 2 == 0 ? 4.0F : static_cast<float>(i);
        scene.motion.instances.push_back(at(later).world_from_object);
        scene.instances.push_back(instance);
    }
    for (int32_t i = 0; i < 5; ++i)
        scene.instances.push_back(at(3, 0, 100 + i));  // it stands still
    EXPECT_EQ(leave_out_copies(scene).size(), 29U);
    EXPECT_EQ(scene.instances.size(), 36U);
}

}  // namespace
}  // namespace obscura
