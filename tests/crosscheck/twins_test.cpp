// tests/crosscheck/twins_test.cpp - meshes of shapes lie on them, and meet rays where they do.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/twins.h"

#include "crosscheck/check_scenes.h"
#include "crosscheck/shape_side.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace obscura {
namespace {

using namespace test;

constexpr uint64_t ray_count = 9216;  // each group of rays once

ShapeRow moved(ShapeRow row) {
    row.centre[0] = 0.5F;
    row.centre[1] = -2;
    row.centre[2] = 0.25F;
    return row;
}

/// x^2 / 4 + y^2 + z^2 / 2 = 1 in a box that cuts it at x = 1.
ShapeRow cut_ellipsoid() {
    ShapeRow row = make_shape(ShapeKind::quadric, 1, 1.2F, 1.6F);
    row.k[0] = 0.25F;
    row.k[1] = 1;
    row.k[2] = 0.5F;
    row.k[9] = -1;
    return row;
}

ShapeRow saddle() {
    ShapeRow row = make_shape(ShapeKind::quadric_from_above, 1, 0.8F, 1);
    row.k[0] = 1;
    row.k[2] = -1;
    row.k[7] = -1.5F;
    return row;
}

double area_of(const ShapeMesh& mesh) {
    double sum = 0;
    for (const std::array<Vec3d, 3>& t : mesh.triangles)
        sum += length(cross(t[1] - t[0], t[2] - t[0])) / 2;
    return sum;
}

std::vector<ShapeRow> all_kinds() {
    return {make_shape(ShapeKind::sphere, 1.5F),
            moved(make_shape(ShapeKind::box, 1, 2, 0.5F)),
            moved(make_shape(ShapeKind::frustum, 1, 0.75F, 0.25F)),
            moved(make_shape(ShapeKind::capsule, 1, 0.75F, 0.25F)),
            make_shape(ShapeKind::plane, 1, 2),
            moved(make_shape(ShapeKind::disk, 1, 0.5F)),
            moved(cut_ellipsoid()),
            saddle()};
}

TEST(Tessellation, AreasAreThoseOfTheShapes) {
    const std::vector<ShapeRow> shapes = all_kinds();
    const double slant = std::hypot(2, 0.5);
    const double expected[] = {4 * pi_d * 1.5 * 1.5,
                               8 * (1 * 2 + 2 * 0.5 + 1 * 0.5),
                               pi_d * (0.75 * 0.75 + 0.25 * 0.25 + slant * (0.75 + 0.25))};
    for (size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(area_of(tessellate(shapes[i])), expected[i], 1e-4 * expected[i]) << i;
    EXPECT_NEAR(area_of(tessellate(shapes[4])), 8, 1e-9);
    EXPECT_NEAR(area_of(tessellate(shapes[5])), pi_d * 0.75, 1e-4);
}

TEST(Tessellation, VerticesLieOnTheSurface) {
    for (const ShapeRow& row : all_kinds()) {
        const ShapeMesh mesh = tessellate(row);
        ASSERT_FALSE(mesh.triangles.empty()) << row.kind;
        double worst = 0;
        for (size_t i = 0; i < mesh.triangles.size(); i += 97) {
            for (const Vec3d& p : mesh.triangles[i])
                worst = std::max(worst, std::abs(side_of_shape(row, p)));
        }
        const bool open = row.kind == static_cast<int32_t>(ShapeKind::plane) ||
                          row.kind == static_cast<int32_t>(ShapeKind::disk);
        EXPECT_LT(worst, open ? 1e-15 : 1e-7) << row.kind;
        EXPECT_LT(mesh.error_m, 1e-3) << row.kind;
    }
}

TEST(Tessellation, WhatAGridCannotShowHasNoMesh) {
    ShapeRow cone = make_shape(ShapeKind::quadric, 1, 1, 1);
    cone.k[0] = cone.k[2] = 1;
    cone.k[1] = -1;
    EXPECT_TRUE(tessellate(cone).triangles.empty());
    EXPECT_TRUE(tessellate(make_shape(ShapeKind::plane, unbounded, 1)).triangles.empty());
}

TEST(Twins, RaysMeetThemWhereTheyMeetTheShapes) {
    Scene scene = empty_scene({});
    for (const ShapeRow& row : all_kinds())
        add_shape(scene, row, 0);
    add_shape(scene, make_shape(ShapeKind::sphere, 1.5F), 0);
    const auto report = check_twins(scene, ray_count * all_kinds().size(), "");
    ASSERT_TRUE(report);
    EXPECT_EQ(report->shapes, all_kinds().size()) << "equal ones once";
    const Tally total = report->figures->total();
    EXPECT_EQ(total.rays, ray_count * all_kinds().size());
    EXPECT_GT(total.hits, total.rays / 4);
    EXPECT_EQ(total.unexplained(), 0U);
}

TEST(Twins, AWrongShapeIsSeen) {
    const ShapeRow row = make_shape(ShapeKind::capsule, 1, 0.75F, 0.25F);
    const ShapeRow other = make_shape(ShapeKind::capsule, 1, 0.75F, 0.251F);
    const auto right = compare_with_mesh(row, tessellate(row), ray_count, "");
    const auto wrong = compare_with_mesh(other, tessellate(row), ray_count, "");
    ASSERT_TRUE(right && wrong);
    EXPECT_EQ(right->total().unexplained(), 0U);
    EXPECT_GT(wrong->total().unexplained(), 100U);
}

}  // namespace
}  // namespace obscura
