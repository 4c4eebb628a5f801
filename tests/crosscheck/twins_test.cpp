// tests/crosscheck/twins_test.cpp - meshes of shapes lie on them and have the same hits.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/twins.h"

#include "crosscheck/check_scenes.h"
#include "crosscheck/shape_side.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace obscura::crosscheck {
namespace {

using namespace test;

constexpr uint64_t ray_count = 9216;  // each group of rays once

ShapeRecord moved(ShapeRecord record) {
    record.centre[0] = 0.5F;
    record.centre[1] = -2;
    record.centre[2] = 0.25F;
    return record;
}

/// x^2 / 4 + y^2 + z^2 / 2 = 1 in a box that cuts it at x = 1.
ShapeRecord cut_ellipsoid() {
    ShapeRecord record = make_shape(ShapeKind::quadric, 1, 1.2F, 1.6F);
    record.k[0] = 0.25F;
    record.k[1] = 1;
    record.k[2] = 0.5F;
    record.k[9] = -1;
    return record;
}

ShapeRecord saddle() {
    ShapeRecord record = make_shape(ShapeKind::quadric_from_above, 1, 0.8F, 1);
    record.k[0] = 1;
    record.k[2] = -1;
    record.k[7] = -1.5F;
    return record;
}

double area_of(const ShapeMesh& mesh) {
    double sum = 0;
    for (const std::array<Vec3d, 3>& t : mesh.triangles)
        sum += length(cross(t[1] - t[0], t[2] - t[0])) / 2;
    return sum;
}

std::vector<ShapeRecord> all_kinds() {
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
    const std::vector<ShapeRecord> shapes = all_kinds();
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
    for (const ShapeRecord& record : all_kinds()) {
        const ShapeMesh mesh = tessellate(record);
        ASSERT_FALSE(mesh.triangles.empty()) << record.kind;
        double worst = 0;
        for (size_t i = 0; i < mesh.triangles.size(); i += 97) {
            for (const Vec3d& p : mesh.triangles[i])
                worst = std::max(worst, std::abs(side_of_shape(record, p)));
        }
        const bool open = record.kind == static_cast<int32_t>(ShapeKind::plane) ||
                          record.kind == static_cast<int32_t>(ShapeKind::disk);
        EXPECT_LT(worst, open ? 1e-15 : 1e-7) << record.kind;
        EXPECT_LT(mesh.error_m, 1e-3) << record.kind;
    }
}

TEST(Tessellation, WhatAGridCannotShowHasNoMesh) {
    ShapeRecord cone = make_shape(ShapeKind::quadric, 1, 1, 1);
    cone.k[0] = cone.k[2] = 1;
    cone.k[1] = -1;
    EXPECT_TRUE(tessellate(cone).triangles.empty());
    EXPECT_TRUE(tessellate(make_shape(ShapeKind::plane, unbounded, 1)).triangles.empty());
}

TEST(Twins, RaysMeetThemWhereTheyMeetTheShapes) {
    Scene scene = empty_scene({});
    for (const ShapeRecord& record : all_kinds())
        add_shape(scene, record, 0);
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
    const ShapeRecord record = make_shape(ShapeKind::capsule, 1, 0.75F, 0.25F);
    const ShapeRecord other = make_shape(ShapeKind::capsule, 1, 0.75F, 0.251F);
    const auto right = compare_with_mesh(record, tessellate(record), ray_count, "");
    const auto wrong = compare_with_mesh(other, tessellate(record), ray_count, "");
    ASSERT_TRUE(right && wrong);
    EXPECT_EQ(right->total().unexplained(), 0U);
    EXPECT_GT(wrong->total().unexplained(), 100U);
}

}  // namespace
}  // namespace obscura::crosscheck
