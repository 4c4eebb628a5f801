// tests/scene/edge_scale_test.cpp - scenes of ordinary size are left alone, others are scaled.
// SPDX-License-Identifier: Apache-2.0
#include "scene/edge_scale.h"

#include <gtest/gtest.h>

#include <cmath>

namespace obscura {
namespace {

float scale_of(float reach, bool moving = false) {
    Scene scene;
    scene.positions = {0, moving ? 0 : -reach, 0};
    if (moving) scene.motion.positions = {0, 0, -reach};
    return edge_scale(scene);
}

TEST(EdgeScale, IsOneForScenesOfOrdinarySize) {
    for (const float reach : {0.0f, 1e-3f, 1.0f, 40.0f, 1e6f})
        EXPECT_EQ(scale_of(reach), 1.0f) << reach;
}

TEST(EdgeScale, BringsTheFarthestCoordinateNear) {
    for (const float reach : {1e-15f, 3e-9f, 9e-4f, 1.5e6f, 1e10f, 1e18f}) {
        for (const bool moving : {false, true}) {
            const float scale = scale_of(reach, moving);
            int exponent = 0;
            EXPECT_EQ(std::frexp(scale, &exponent), 0.5f) << "a power of two";
            EXPECT_GE(reach * scale, reach < 1.0f ? 1.0f : 4e5f) << reach;
            EXPECT_LE(reach * scale, reach < 1.0f ? 2.0f : 1.1e6f) << reach;
        }
    }
}

}  // namespace
}  // namespace obscura
