// tests/explain/camera_working_test.cpp - every camera's steps end at the ray of its definition.
// SPDX-License-Identifier: Apache-2.0
#include "explain/camera_working.h"

#include "camera/camera_models.h"
#include "camera/closed_rays.h"

#include <gtest/gtest.h>

namespace obscura::test {
namespace {

constexpr int width = 36;
constexpr int height = 24;

TEST(CameraWorking, EveryCamerasRayIsThatOfItsDefinition) {
    for (const NamedCamera& named : all_cameras()) {
        int seen = 0;
        for (int i = 0; i < width * height; ++i) {
            const int x = i % width;
            const int y = i / width;
            const ClosedRay expected = closed_ray(named.camera, {x, y, width, height});
            const CameraWorking got = work_out_camera(named.camera, {x, y, width, height});
            ASSERT_EQ(got.sees, expected.seen) << named.name << " " << x << " " << y;
            if (!got.sees) continue;
            ++seen;
            ASSERT_LT(length(got.ray.origin - expected.origin), 1e-12) << named.name;
            ASSERT_LT(length(got.ray.direction - expected.direction), 1e-9) << named.name << i;
            ASSERT_EQ(got.terms[0].value[0], (x + 0.5) / width);
        }
        EXPECT_GT(seen, 300) << named.name;
    }
}

TEST(CameraWorking, NearAndFarCutPiecesOffTheRay) {
    for (NamedCamera& named : all_cameras()) {
        named.camera.near_m = 2;
        named.camera.far_m = 7;
        const ClosedRay whole = closed_ray(named.camera, {20, 9, width, height});
        const CameraWorking got = work_out_camera(named.camera, {20, 9, width, height});
        if (!got.sees) continue;
        const Vec3d end = got.ray.origin + got.ray.direction * got.length_m;
        const auto& m = named.camera.world_from_camera.m;
        const Vec3d eye{m[0][3], m[1][3], m[2][3]};
        const Vec3d back{m[0][2], m[1][2], m[2][2]};
        if (measures_from_eye(named.camera.model)) {
            EXPECT_NEAR(length(got.ray.origin - whole.origin), 2, 1e-6) << named.name;
            EXPECT_NEAR(length(end - whole.origin), 7, 1e-6) << named.name;
        } else {
            EXPECT_NEAR(dot(eye - got.ray.origin, back), 2, 1e-6) << named.name;
            EXPECT_NEAR(dot(eye - end, back), 7, 1e-6) << named.name;
        }
    }
}

}  // namespace
}  // namespace obscura::test
