// tests/session/framed_geometry_test.cpp - the farthest points of scenes, against looking at all.
// SPDX-License-Identifier: Apache-2.0
#include "session/framed_geometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace obscura {
namespace {

/// 20000 triangles in a mesh, so that it has several boxes, and two instances of it.
Scene instanced_cloud() {
    Scene scene;
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    constexpr uint32_t triangles = 20000;
    for (uint32_t i = 0; i < 3 * triangles; ++i) {
        for (const float size : {1.0F, 2.0F, 0.5F})
            scene.positions.push_back(size * normal(random));
        scene.indices.push_back(i);
    }
    pad_tables(scene);
    Primitive primitive;
    primitive.triangle_count = triangles;
    scene.primitives = {primitive};
    scene.meshes = {Mesh{0, 1, 0}};
    Instance plain;
    plain.node = 0;
    Instance turned;
    turned.node = 1;
    turned.world_from_object = {{{0, 0, 3, 10}, {-1, 0, 0, 2}, {0, 1.5F, 0, -7}}};
    scene.instances = {plain, turned};
    return scene;
}

std::vector<Vec3d> all_points(const Scene& scene, const std::vector<char>& nodes = {}) {
    std::vector<Vec3d> out;
    for (const Instance& instance : scene.instances) {
        if (!nodes.empty() && nodes[static_cast<size_t>(instance.node)] == 0) continue;
        for (const uint32_t v : scene.indices) {
            const float* at = &scene.positions[3 * size_t{v}];
            const Vec3f p = transform_point(instance.world_from_object, Vec3f{at[0], at[1], at[2]});
            out.push_back({p.x, p.y, p.z});
        }
    }
    return out;
}

void expect_farthest(const Scene& scene, const std::vector<char>& nodes) {
    const FramedGeometry geometry(scene, nodes);
    const std::vector<Vec3d> points = all_points(scene, nodes);
    for (const Vec3d& direction : {Vec3d{1, 0, 0}, Vec3d{-1, 2, 0.5}, Vec3d{0.1, -0.2, -3}}) {
        double most = -INFINITY;
        for (const Vec3d& p : points)
            most = std::max(most, dot(p, direction));
        EXPECT_NEAR(dot(geometry.farthest(direction), direction), most, 1e-4);
    }
    const Vec3d centre = {1, 1, 1};
    double most = 0;
    for (const Vec3d& p : points)
        most = std::max(most, length(p - centre));
    EXPECT_NEAR(geometry.farthest_from(centre), most, 1e-4);
}

TEST(FramedGeometry, FindsTheFarthestVertexOfAllInstances) {
    const Scene scene = instanced_cloud();
    expect_farthest(scene, {});
    expect_farthest(scene, {1, 0});
    expect_farthest(scene, {0, 1});
    EXPECT_TRUE(FramedGeometry(scene, {0, 0}).empty());
}

TEST(FramedGeometry, BallsCountByTheirSurface) {
    Scene scene;
    ShapeRecord ball;
    ball.centre[0] = 5;
    ball.size[0] = 2;
    scene.shapes = {ball};
    Primitive primitive;
    primitive.triangle_count = 1;
    primitive.geometry = static_cast<int32_t>(GeometryKind::shapes);
    scene.primitives = {primitive};
    scene.world_primitive_count = 1;
    const FramedGeometry geometry(scene);
    const Vec3d diagonal = normalize(Vec3d{1, 1, 0});
    EXPECT_NEAR(dot(geometry.farthest(diagonal), diagonal), 5 * std::sqrt(0.5) + 2, 1e-5);
    EXPECT_NEAR(geometry.farthest_from({0, 0, 0}), 7, 1e-5);
    EXPECT_NEAR(static_cast<double>(geometry.box().low.y), -2, 1e-5);
}

TEST(FramedGeometry, ABoxHasItsCorners) {
    EXPECT_TRUE(FramedGeometry(Bounds{}).empty());
    const FramedGeometry box(Bounds{{0, 0, 0}, {1, 2, 3}});
    EXPECT_EQ(box.farthest({1, -1, 1}).z, 3);
    EXPECT_EQ(box.farthest({1, -1, 1}).y, 0);
    EXPECT_EQ(box.box().high.y, 2);
}

TEST(KeptGeometry, FollowsItsSceneAndIsMadeForOtherNodes) {
    Scene scene = instanced_cloud();
    const auto reach = [](const FramedGeometry& geometry) {
        const Vec3d direction = {-1, 2, 0.5};
        return dot(geometry.farthest(direction), direction);
    };
    const double most = reach(FramedGeometry(scene));
    KeptGeometry kept;
    EXPECT_EQ(reach(kept.of(scene, {})), most);
    Scene moved = std::move(scene);
    scene = {};  // what it was is gone
    EXPECT_EQ(reach(kept.of(moved, {})), most);
    EXPECT_EQ(reach(kept.of(moved, {0, 1})), reach(FramedGeometry(moved, {0, 1})));
    EXPECT_EQ(reach(kept.of(moved, {})), most);
    moved.instances[1].world_from_object = {{{1, 0, 0, 1000}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    kept.forget();
    EXPECT_EQ(kept.of(moved, {}).box().high.x, FramedGeometry(moved).box().high.x);
    EXPECT_GT(kept.of(moved, {}).box().high.x, 900);
}

}  // namespace
}  // namespace obscura
