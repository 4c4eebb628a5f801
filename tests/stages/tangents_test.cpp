// tests/stages/tangents_test.cpp - shading normals that the viewer would see from behind.
// SPDX-License-Identifier: Apache-2.0
#include "math/warp.h"
#include "stages/3_tangents.h"

#include <gtest/gtest.h>

#include "support/lane_arrays.h"
#include "support/layered_materials.h"

namespace obscura::test {
namespace {

Vec3<Lanes> all_lanes(const Vec3f& v) {
    return {Lanes(v.x), Lanes(v.y), Lanes(v.z)};
}

Vec3f bent(const Vec3f& normal, const Vec3f& to_viewer) {
    const Vec3f up{0, 0, 1};
    return lane(bend_towards_viewer(all_lanes(normal), all_lanes(up), all_lanes(to_viewer)), 0);
}

Vec3f tilted(float degrees) {
    const double angle = static_cast<double>(degrees) * radians_per_degree;
    return {static_cast<float>(std::sin(angle)), 0, static_cast<float>(std::cos(angle))};
}

TEST(BentNormals, MirrorTheViewerAboveTheSurface) {
    Pcg32 random(3);
    for (int i = 0; i < 100000; ++i) {
        const Vec3f normal = normalize(direction_above(random, 0.001f));
        const Vec3f viewer = normalize(direction_above(random, 0.001f));
        const Vec3f n = bent(normal, viewer);
        const Vec3f image = n * (2 * dot(n, viewer)) - viewer;
        ASSERT_NEAR(dot(n, n), 1, 1e-4f);
        ASSERT_GT(dot(n, viewer), 0) << i;
        ASSERT_GT(image.z, std::min(0.0099f, 0.89f * viewer.z) - 1e-4f) << i;
        const Vec3f asked = normal * (2 * dot(normal, viewer)) - viewer;
        if (dot(normal, viewer) > 0 && asked.z > 0.0101f) {
            ASSERT_NEAR(n.x, normal.x, 1e-6f) << "nothing was to be done";
        }
    }
}

/// Far tilts do not jump to the viewer's side: normal maps would have black spots.
TEST(BentNormals, FollowTheirTiltWithoutAJump) {
    for (const float view : {30.0f, 60.0f, 75.0f, 85.0f}) {
        for (float tilt = 0; tilt < 89; ++tilt) {
            const Vec3f here = bent(tilted(-tilt), tilted(view));
            const Vec3f next = bent(tilted(-tilt - 1), tilted(view));
            ASSERT_GT(dot(here, next), std::cos(1.1 * radians_per_degree)) << view << ", " << tilt;
        }
    }
}

}  // namespace
}  // namespace obscura::test
