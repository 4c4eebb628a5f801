// tests/crosscheck/leaks_test.cpp - closed meshes and shapes, points inside of them, and leaks.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/leaks.h"

#include "crosscheck/check_scenes.h"

#include <gtest/gtest.h>

namespace obscura::crosscheck {
namespace {

using namespace test;

TEST(ClosedComponents, ACubeIsClosedAndAnOpenOneIsNot) {
    EXPECT_EQ(find_closed_components(closed_cube(), 8).found, 1U);
    Scene open = closed_cube();
    open.primitives[0].triangle_count = 11;
    EXPECT_EQ(find_closed_components(open, 8).found, 0U);
    Scene turned = closed_cube();  // one triangle the wrong way round: no side is outside
    std::swap(turned.indices[0], turned.indices[1]);
    EXPECT_EQ(find_closed_components(turned, 8).found, 0U);
}

TEST(ClosedComponents, VerticesAreOneWhereTheyCoincide) {
    Scene split = closed_cube();  // three vertices a triangle
    LargeArray<float> positions;
    for (size_t i = 0; i < 36; ++i) {
        for (size_t c = 0; c < 3; ++c)
            positions.push_back(split.positions[3 * split.indices[i] + c]);
        split.indices[i] = static_cast<uint32_t>(i);
    }
    split.positions = positions;
    pad_tables(split);
    const ClosedComponents closed = find_closed_components(split, 8);
    ASSERT_EQ(closed.found, 1U);
    EXPECT_EQ(closed.components[0].items, 12U);
}

TEST(ClosedComponents, SolidShapesAreClosed) {
    Scene scene = empty_scene({});
    add_shape(scene, make_shape(ShapeKind::sphere, 1), 0);
    add_shape(scene, make_shape(ShapeKind::disk, 1, 0), 0);
    add_shape(scene, make_shape(ShapeKind::box, 1, 1, 1), 0, Affined{});
    EXPECT_EQ(find_closed_components(scene, 8).found, 2U);
}

TEST(Leaks, PointsInsideAreInside) {
    const Scene cube = closed_cube();
    const TrueScene truth(cube);
    const std::vector<Vec3d> points = points_inside(truth, 500, 0);
    ASSERT_EQ(points.size(), 500U);
    for (const Vec3d& p : points)
        EXPECT_LT(max_component(abs(p)), 1);
}

TEST(Leaks, NoneFromAClosedCube) {
    const auto report = count_leaks(find_closed_components(closed_cube(), 8), 200000, 0);
    ASSERT_TRUE(report.has_value());
    EXPECT_EQ(report->components_used, 1U);
    ASSERT_EQ(report->kernels.size(), 3U);
    EXPECT_EQ(report->kernels[0].by_aim[0].rays, 200000U);
    EXPECT_EQ(report->kernels[0].by_aim[2].rays, 20000U);
    for (const LeakFigures& kernel : report->kernels)
        EXPECT_EQ(kernel.by_aim[0].leaks, 0U) << kernel.kernel;
}

TEST(Leaks, AHoleIsFound) {
    ClosedComponents closed = find_closed_components(closed_cube(), 8);
    const TrueScene whole(closed.components[0].scene);
    const std::vector<Vec3d> inside = points_inside(whole, 4, 0);
    ASSERT_FALSE(inside.empty());
    // A cube that lost a triangle after it was found: inside is where parity is odd.
    closed.components[0].scene.primitives[0].triangle_count = 11;
    const auto report = count_leaks(closed, 20000, 0);
    ASSERT_TRUE(report.has_value());
    EXPECT_GT(report->kernels.at(0).by_aim[0].leaks, 100U);
    EXPECT_TRUE(report->kernels.at(0).first.has_value());
}

}  // namespace
}  // namespace obscura::crosscheck
