// tests/accel/crossings_test.cpp - all boundaries of media along a ray, of any geometry.
// SPDX-License-Identifier: Apache-2.0
#include "accel/accel_scenes.h"

#include <gtest/gtest.h>

#include "support/shape_scenes.h"
#include <algorithm>

namespace obscura::test {
namespace {

/// Where a ray enters (+) and leaves (-) a medium: metres with a sign.
std::vector<float> ways(const Scene& scene, const Vec3f& origin, const Vec3f& direction) {
    const BuiltScene built = build(scene);
    const RayColumns ray{&origin.x,
                         &origin.y,
                         &origin.z,
                         &direction.x,
                         &direction.y,
                         &direction.z,
                         nullptr,
                         nullptr,
                         1};
    std::vector<Crossing> faces;
    built.accel.list_crossings(ray, 0, {}, faces);
    std::sort(
        faces.begin(), faces.end(), [](const Crossing& a, const Crossing& b) { return a.t < b.t; });
    std::vector<float> out;
    for (const Crossing& face : faces) {
        const float way = std::round(face.t * 1000.0f) / 1000.0f * (face.enters ? 1.0f : -1.0f);
        if (out.empty() || out.back() != way) out.push_back(way);
    }
    return out;
}

/// Material 0 bounds a medium, material 1 does not.
Scene media_scene(SceneBuilder&& builder) {
    Scene scene = builder.take();
    scene.materials[0].layers = 0;
    scene.layers.resize(1);
    scene.layers[0].medium = 1;
    scene.media.resize(2);
    return scene;
}

Scene nothing_yet() {
    SceneBuilder builder;
    builder.material({});
    builder.material({});
    return media_scene(std::move(builder));
}

using Ways = std::vector<float>;
constexpr Vec3f from{0.01f, 0.02f, 10};
constexpr Vec3f ahead{0, 0, -1};

TEST(Crossings, TrianglesOfMediaAlone) {
    SceneBuilder builder;
    builder.material({});
    builder.material({});
    builder.quad({-1, -1, 2}, {2, 0, 0}, {0, 2, 0}, 0);
    builder.quad({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, 1);
    builder.quad({-1, -1, 0}, {0, 2, 0}, {2, 0, 0}, 0);
    builder.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 0);
    builder.quad({-1, -1, -9}, {0, 2, 0}, {2, 0, 0}, 0);
    const Scene scene = media_scene(std::move(builder));
    const Ways found = ways(scene, from, ahead);
    ASSERT_EQ(found.size(), 4U);
    EXPECT_EQ(found.front(), 8);
    EXPECT_EQ(found.back(), -19);
    EXPECT_EQ(found[1], -found[2]) << "both in the same place";
}

TEST(Crossings, AnalyticShapesAndParticles) {
    Scene scene = nothing_yet();
    add_shape(scene, make_shape(ShapeKind::box, 1, 1, 2), 0);
    add_shape(scene, make_shape(ShapeKind::box, 3, 3, 3), 1);
    EXPECT_EQ(ways(scene, from, ahead), (Ways{8, -12}));
    Scene two = nothing_yet();
    std::vector<float> spheres(4 * 40, 50.0f);  // more than a block of them
    std::fill_n(&spheres[4 * 37], 3, 0.0f);
    spheres[4 * 37 + 3] = 3;
    add_spheres(two, spheres, 0);
    const Ways found = ways(two, {0, 0, 10}, ahead);
    EXPECT_TRUE(std::find(found.begin(), found.end(), 7.0f) != found.end());
    EXPECT_TRUE(std::find(found.begin(), found.end(), -13.0f) != found.end());
}

TEST(Crossings, MirroredInstancesKeepTheirSides) {
    Scene scene = nothing_yet();
    add_shape(scene, make_shape(ShapeKind::sphere, 1), 0, scaling(-2, 2, 2));
    const Ways found = ways(scene, {0, 0, 10}, ahead);
    EXPECT_EQ(found, (Ways{8, -12}));
    SceneBuilder builder;
    builder.material({});
    builder.material({});
    builder.quad({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, 0);
    Scene mesh = instanced(media_scene(std::move(builder)), {scaling(-1, 1, 1)});
    EXPECT_EQ(ways(mesh, from, ahead), Ways{9});
}

TEST(Crossings, PlanesWithoutEnd) {
    Scene scene = nothing_yet();
    add_shape(scene, make_shape(ShapeKind::plane, unbounded, unbounded), 0);
    EXPECT_EQ(ways(scene, {0, 3, 0}, {0, -1, 0}), Ways{3});
    EXPECT_EQ(ways(scene, {0, -3, 0}, {0, 1, 0}), Ways{-3});
}

}  // namespace
}  // namespace obscura::test
