// tests/session/framing_test.cpp - automatic views show the whole asset, at every scale and shape.
// SPDX-License-Identifier: Apache-2.0
#include "session/framing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace obscura {
namespace {

Bounds box(const Vec3f& low, const Vec3f& high) {
    return {low, high};
}

std::vector<Vec3d> corners(const Bounds& bounds) {
    std::vector<Vec3d> out;
    for (int i = 0; i < 8; ++i) {
        out.push_back({(i & 1) != 0 ? bounds.high.x : bounds.low.x,
                       (i & 2) != 0 ? bounds.high.y : bounds.low.y,
                       (i & 4) != 0 ? bounds.high.z : bounds.low.z});
    }
    return out;
}

Framing frame_perspective(const Bounds& bounds, double yfov_rad, double aspect) {
    return frame_view(FramedGeometry(bounds), {}, {yfov_rad, aspect, false});
}

Framing frame_orthographic(const Bounds& bounds, double aspect) {
    return frame_view(FramedGeometry(bounds), {}, {default_yfov_rad, aspect, true});
}

/// The window in which points are seen, in fractions of the half image: left, right, bottom, top.
std::array<double, 4> window(const std::vector<Vec3d>& points,
                             const Framing& framing,
                             const FrameLens& lens) {
    const Affined camera_from_world = inverse(look_at(framing.view).value());
    std::array<double, 4> out = {2, -2, 2, -2};
    for (const Vec3d& point : points) {
        const Vec3d p = transform_point(camera_from_world, point);
        const double half =
            lens.orthographic ? framing.half_height_m : framing.tan_half_yfov * -p.z;
        EXPECT_LT(p.z, 0);
        out[0] = std::min(out[0], p.x / (half * lens.aspect));
        out[1] = std::max(out[1], p.x / (half * lens.aspect));
        out[2] = std::min(out[2], p.y / half);
        out[3] = std::max(out[3], p.y / half);
    }
    return out;
}

/// Points on an uneven shape, with a spike towards one corner of its box; as a scene, too.
std::vector<Vec3d> spiky_points() {
    std::vector<Vec3d> out;
    for (int i = 0; i < 300; ++i) {
        const double a = 0.1 * i;
        const double r = 1 + 0.3 * std::sin(7 * a);
        out.push_back(
            {r * std::cos(a) * std::cos(0.3 * a), 0.4 * std::sin(0.3 * a), r * std::sin(a)});
    }
    out.push_back({4, 3, -5});
    return out;
}

Scene scene_of(const std::vector<Vec3d>& points) {
    Scene scene;
    for (const Vec3d& p : points) {
        for (const double x : {p.x, p.y, p.z})
            scene.positions.push_back(static_cast<float>(x));
    }
    for (uint32_t i = 0; i + 2 < points.size() + 2; ++i) {
        const auto last = static_cast<uint32_t>(points.size()) - 1;
        for (const uint32_t v : {i, std::min(i + 1, last), std::min(i + 2, last)})
            scene.indices.push_back(std::min(v, last));
    }
    pad_tables(scene);
    Primitive primitive;
    primitive.triangle_count = static_cast<int32_t>(points.size());
    primitive.node = 0;
    scene.primitives = {primitive};
    scene.world_primitive_count = 1;
    return scene;
}

/// Largest fraction of the half frame that a corner reaches; 2 when one is behind the camera.
double reach(const Bounds& bounds, const Framing& framing, double aspect, bool perspective) {
    const Result<Affined> world_from_camera = look_at(framing.view);
    EXPECT_TRUE(world_from_camera);
    const Affined camera_from_world = inverse(*world_from_camera);
    const double distance = length(framing.view.eye_m - framing.view.target_m);
    double most = 0;
    for (const Vec3d& corner : corners(bounds)) {
        const Vec3d p = transform_point(camera_from_world, corner);
        if (p.z >= 0) return 2;
        const double half_height =
            perspective ? framing.half_height_m * -p.z / distance : framing.half_height_m;
        most =
            std::max({most, std::abs(p.y) / half_height, std::abs(p.x) / (half_height * aspect)});
    }
    return most;
}

TEST(Framing, EveryCornerIsInsideAndTheFitIsTight) {
    const Bounds shapes[] = {box({-1, -1, -1}, {1, 1, 1}),
                             box({0, 0, 0}, {5, 0.5f, 0.1f}),
                             box({-3, 10, 7}, {-2.9f, 19, 7.2f}),
                             box({-2, -2, 0}, {2, 2, 0})};
    for (const Bounds& shape : shapes) {
        for (const float scale : {1e-3f, 1.0f, 1e5f}) {
            const Bounds scaled = box(shape.low * scale, shape.high * scale);
            for (const double aspect : {0.3, 1.0, 16.0 / 9, 4.0}) {
                SCOPED_TRACE(aspect);
                const Framing near = frame_perspective(scaled, default_yfov_rad, aspect);
                EXPECT_NEAR(reach(scaled, near, aspect, true), 0.9, 1e-6);
                const Framing parallel = frame_orthographic(scaled, aspect);
                EXPECT_NEAR(reach(scaled, parallel, aspect, false), 0.9, 1e-6);
            }
        }
    }
}

TEST(Framing, WhatIsSeenIsCentredAndReachesTheMargin) {
    const std::vector<Vec3d> points = spiky_points();
    const Scene scene = scene_of(points);
    for (const double aspect : {0.5, 1.0, 2.0}) {
        for (const bool orthographic : {false, true}) {
            for (const double azimuth : {0.0, 1.0, -2.5}) {
                FramingOptions options;
                options.azimuth_rad = azimuth;
                options.roll_rad = 0.3 * azimuth;
                options.elevation_rad = 0.5 * azimuth;
                options.margin = 0.1;
                const FrameLens lens{default_yfov_rad, aspect, orthographic};
                const Framing framing = frame_view(FramedGeometry(scene), options, lens);
                const auto seen = window(points, framing, lens);
                EXPECT_NEAR(seen[0], -seen[1], 1e-5);
                EXPECT_NEAR(seen[2], -seen[3], 1e-5);
                EXPECT_NEAR(std::max(seen[1], seen[3]), 0.8, 1e-5);
            }
        }
    }
}

TEST(Framing, AnglesAreThoseOfTheEye) {
    const Bounds cube = box({-1, -1, -1}, {1, 1, 1});
    const auto eye = [&](double azimuth, double elevation) {
        FramingOptions options;
        options.azimuth_rad = azimuth * M_PI / 180;
        options.elevation_rad = elevation * M_PI / 180;
        const Viewpoint view =
            frame_view(FramedGeometry(cube), options, {default_yfov_rad, 1, true}).view;
        EXPECT_TRUE(look_at(view));
        return normalize(view.eye_m);
    };
    EXPECT_NEAR(eye(0, 0).z, 1, 1e-6);
    EXPECT_NEAR(eye(90, 0).x, 1, 1e-6);
    EXPECT_NEAR(eye(-90, 0).x, -1, 1e-6);
    EXPECT_NEAR(eye(180, 0).z, -1, 1e-6);
    EXPECT_NEAR(eye(40, 90).y, 1, 1e-6);
    EXPECT_NEAR(eye(40, -30).y, -0.5, 1e-6);
}

TEST(Framing, ARollTurnsTheImageClockwise) {
    FramingOptions options;
    options.azimuth_rad = 0;
    options.elevation_rad = 0;
    options.roll_rad = M_PI / 2;
    const FrameLens lens{default_yfov_rad, 1, true};
    const Framing framing = frame_view(FramedGeometry(box({-1, -1, -1}, {1, 1, 1})), options, lens);
    const auto top = window({{0, 1, 0}}, framing, lens);  // 12 o'clock goes to 3 o'clock
    EXPECT_NEAR(top[0], 0.9, 1e-6);
    EXPECT_NEAR(top[2], 0, 1e-6);
}

TEST(Framing, AZoomEnlargesAboutTheMiddle) {
    const std::vector<Vec3d> points = spiky_points();
    const Scene scene = scene_of(points);
    const FrameLens lens{default_yfov_rad, 1.5, false};
    FramingOptions options;
    const auto once = window(points, frame_view(FramedGeometry(scene), options, lens), lens);
    options.zoom = 3;
    const auto thrice = window(points, frame_view(FramedGeometry(scene), options, lens), lens);
    for (size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(thrice[i], 3 * once[i], 1e-9);
}

TEST(Framing, ASphereHasOneScaleFromAllSides) {
    const std::vector<Vec3d> points = spiky_points();
    const Scene scene = scene_of(points);
    FramingOptions options;
    options.fit = FrameFit::sphere;
    std::vector<double> distances;
    for (const double azimuth : {0.0, 1.0, 2.0}) {
        options.azimuth_rad = azimuth;
        const FrameLens lens{default_yfov_rad, 1.5, false};
        const Framing framing = frame_view(FramedGeometry(scene), options, lens);
        distances.push_back(length(framing.view.eye_m - framing.view.target_m));
        const auto seen = window(points, framing, lens);
        for (const double edge : seen)
            EXPECT_LE(std::abs(edge), 0.9 + 1e-6);
    }
    EXPECT_NEAR(distances[0], distances[1], 1e-9);
    EXPECT_NEAR(distances[0], distances[2], 1e-9);
}

TEST(Framing, WideAnglesStillSeeAllCorners) {
    const Bounds cube = box({-1, -1, -1}, {1, 1, 1});
    for (const double degrees : {0.01, 5.0, 90.0, 150.0, 179.0}) {
        const Framing framing = frame_perspective(cube, degrees * M_PI / 180, 1.5);
        EXPECT_LE(reach(cube, framing, 1.5, true), 0.9 + 1e-6) << degrees;
    }
}

TEST(Framing, LooksFromFrontRightAbove) {
    const Framing framing = frame_perspective(box({9, 9, 9}, {11, 11, 11}), default_yfov_rad, 1.5);
    EXPECT_GT(framing.view.eye_m.x, 11);
    EXPECT_GT(framing.view.eye_m.y, 11);
    EXPECT_GT(framing.view.eye_m.z, 11);
    EXPECT_GT(framing.view.eye_m.z - 10, framing.view.eye_m.x - 10) << "more front than side";
}

TEST(Framing, NothingAndAPointGetAFiniteView) {
    for (const Bounds& bounds :
         {Bounds{}, box({3, 3, 3}, {3, 3, 3}), box({1e9f, 0, 0}, {1e9f, 0, 0})}) {
        const Framing framing = frame_perspective(bounds, default_yfov_rad, 1.5);
        const double distance = length(framing.view.eye_m - framing.view.target_m);
        EXPECT_GT(distance, 1);
        EXPECT_TRUE(std::isfinite(distance));
        EXPECT_TRUE(look_at(framing.view));
    }
}

TEST(LookAt, IsRigidAndLooksAtTheTarget) {
    const Result<Affined> m = look_at({{1, 2, 3}, {4, -1, 0}, {0, 1, 0.5}});
    ASSERT_TRUE(m);
    EXPECT_NEAR(determinant(*m), 1, 1e-12);
    const Vec3d target = transform_point(inverse(*m), Vec3d{4, -1, 0});
    EXPECT_NEAR(target.x, 0, 1e-12);
    EXPECT_NEAR(target.y, 0, 1e-12);
    EXPECT_NEAR(target.z, -std::sqrt(27), 1e-12);
    const Vec3d up = transform_vector(inverse(*m), Vec3d{0, 1, 0.5});
    EXPECT_NEAR(up.x, 0, 1e-12);
    EXPECT_GT(up.y, 0);
}

TEST(LookAt, RefusesWhatGivesNoView) {
    for (const Viewpoint& view : {Viewpoint{{1, 1, 1}, {1, 1, 1}, {0, 1, 0}},
                                  Viewpoint{{1, 1, 1}, {1, 5, 1}, {0, 1, 0}},
                                  Viewpoint{{1, 1, 1}, {1, 5, 2}, {0, 0, 0}}}) {
        const Result<Affined> m = look_at(view);
        ASSERT_FALSE(m);
        EXPECT_EQ(m.error().id, "E-CAM-VIEW");
        EXPECT_EQ(m.error().code, ExitCode::usage);
    }
}

Affined scaled_columns(const Affined& m, double x, double y, double z) {
    Affined out = m;
    for (auto& row : out.m) {
        row[0] *= x;
        row[1] *= y;
        row[2] *= z;
    }
    return out;
}

TEST(RigidPart, LeavesOutScaleAndMirroring) {
    const Affined rigid = *look_at({{1, 2, 3}, {4, -1, 0}, {0, 1, 0}});
    for (const double x : {2.0, -2.0, 1e-4}) {
        const Result<Affined> got = rigid_part(scaled_columns(rigid, x, 30, 0.001), "camera");
        ASSERT_TRUE(got);
        for (int r = 0; r < 3; ++r) {
            for (int c = 0; c < 4; ++c)
                EXPECT_NEAR(got->m[r][c], rigid.m[r][c], 1e-12);
        }
    }
}

TEST(RigidPart, KeepsTheViewDirectionOfAShearedNode) {
    const Affined sheared{{{1, 0.5, 0, 0}, {0, 1, 0.5, 0}, {0, 0, 1, 0}}};
    const Result<Affined> got = rigid_part(sheared, "camera");
    ASSERT_TRUE(got);
    EXPECT_NEAR(determinant(*got), 1, 1e-12);
    EXPECT_NEAR(got->m[1][2] / got->m[2][2], 0.5, 1e-12);
}

TEST(RigidPart, RefusesAFlattenedCamera) {
    for (const Affined& flat : {scaled_columns(Affined{}, 1, 0, 1),
                                scaled_columns(Affined{}, 1, 1, 0),
                                Affined{{{1, 0, 0, 0}, {0, 1, 1, 0}, {0, 0, 0, 0}}}}) {
        const Result<Affined> got = rigid_part(flat, "a.gltf camera 'C'");
        ASSERT_FALSE(got);
        EXPECT_EQ(got.error().id, "E-CAM-SINGULAR");
        EXPECT_EQ(got.error().code, ExitCode::bad_data);
        EXPECT_EQ(got.error().where, "a.gltf camera 'C'");
    }
}

}  // namespace
}  // namespace obscura
