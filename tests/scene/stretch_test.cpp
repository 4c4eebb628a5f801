// tests/scene/stretch_test.cpp - which transforms of instances stretch.
// SPDX-License-Identifier: Apache-2.0
#include "scene/stretch.h"

#include <gtest/gtest.h>

#include <cmath>

namespace obscura {
namespace stretch {

bool stretches(const Affinef& transform, bool moves = false) {
    Scene scene;
    scene.instances.resize(1);
    if (moves) {
        scene.motion.instances = {Affinef{}, transform};
    } else {
        scene.instances[0].world_from_object = transform;
    }
    return has_stretched_instances(scene);
}

/// A rotation about the diagonal by an angle, scaled along the axes before it.
Affinef turned(float angle, const Vec3f& scale) {
    const float c = (1 + 2 * std::cos(angle)) / 3;
    const float a = (1 - std::cos(angle)) / 3, b = std::sin(angle) / std::sqrt(3.0f);
    const float rows[3][3] = {{c, a - b, a + b}, {a + b, c, a - b}, {a - b, a + b, c}};
    const float scales[3] = {scale.x, scale.y, scale.z};
    Affinef out;
    for (int r = 0; r < 3; ++r) {
        for (int column = 0; column < 3; ++column)
            out.m[r][column] = rows[r][column] * scales[column];
        out.m[r][3] = 7;
    }
    return out;
}

TEST(Stretch, RotationsReflectionsAndOneScaleDoNot) {
    for (const bool moves : {false, true}) {
        EXPECT_FALSE(stretches({}, moves));
        for (const float angle : {0.1f, 1.0f, 2.5f}) {
            for (const float scale : {1e-6f, 1.0f, 3e5f}) {
                EXPECT_FALSE(stretches(turned(angle, {scale, scale, scale}), moves)) << angle;
                EXPECT_FALSE(stretches(turned(angle, {scale, -scale, scale}), moves)) << angle;
            }
        }
    }
}

TEST(Stretch, ScalesThatDifferAndShearsDo) {
    for (const bool moves : {false, true}) {
        EXPECT_TRUE(stretches(turned(1, {1, 1, 1.01f}), moves));
        EXPECT_TRUE(stretches(turned(1, {1e-3f, 0, 1e-3f}), moves));
        Affinef shear;
        shear.m[0][1] = 0.01f;
        EXPECT_TRUE(stretches(shear, moves));
    }
    EXPECT_FALSE(has_stretched_instances(Scene{}));
}

}  // namespace stretch
}  // namespace obscura
