// tests/dataset/rigid_pose_test.cpp - matrices as a rotation of a stretched model.
// SPDX-License-Identifier: Apache-2.0
#include "dataset/rigid_pose.h"

#include <gtest/gtest.h>

#include <cmath>

namespace obscura::dataset {
namespace {

Affined turned(double angle) {
    Affined out;
    out.m[0][0] = out.m[2][2] = std::cos(angle);
    out.m[0][2] = std::sin(angle);
    out.m[2][0] = -std::sin(angle);
    out.m[0][3] = 3;
    out.m[1][3] = -2;
    return out;
}

Affined scaled(double x, double y, double z) {
    Affined out;
    out.m[0][0] = x;
    out.m[1][1] = y;
    out.m[2][2] = z;
    return out;
}

void expect_equal(const Affined& a, const Affined& b) {
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c)
            EXPECT_NEAR(a.m[r][c], b.m[r][c], 1e-10 * (1 + std::abs(b.m[r][c]))) << r << ',' << c;
    }
}

TEST(RigidPose, PartsOfAProductAreFound) {
    for (const Affined& stretch :
         {scaled(1, 1, 1), scaled(0.01, 0.01, 0.01), scaled(2, 3, 0.1), scaled(1e4, 1, 1e-3)}) {
        const Affined rotation = turned(2.5);
        const RigidPose pose = rigid_pose(compose(rotation, stretch));
        expect_equal(pose.world_from_model, rotation);
        expect_equal(pose.stretch, stretch);
    }
}

TEST(RigidPose, AMirrorIsPartOfTheModel) {
    const Affined matrix = compose(turned(0.4), scaled(-1, 2, 3));
    const RigidPose pose = rigid_pose(matrix);
    EXPECT_NEAR(determinant(pose.world_from_model), 1, 1e-12);
    expect_equal(compose(pose.world_from_model, pose.stretch), matrix);
}

TEST(RigidPose, AShearIsSharedFairly) {
    Affined shear;
    shear.m[0][1] = 0.5;
    const RigidPose pose = rigid_pose(shear);
    expect_equal(compose(pose.world_from_model, pose.stretch), shear);
    EXPECT_NEAR(pose.stretch.m[0][1], pose.stretch.m[1][0], 1e-12);
    EXPECT_NEAR(determinant(pose.world_from_model), 1, 1e-12);
}

TEST(RigidPose, WhatIsFlatStaysWhereItIs) {
    const RigidPose pose = rigid_pose(compose(turned(1), scaled(1, 0, 1)));
    EXPECT_EQ(pose.world_from_model.m[0][3], 3);
    EXPECT_EQ(pose.world_from_model.m[0][0], 1);
}

}  // namespace
}  // namespace obscura::dataset
