// tests/scene/split_curves_test.cpp - lines get a point where they cross a plane; radii are set.
// SPDX-License-Identifier: Apache-2.0
#include "scene/split_curves.h"

#include "scene/points_lines_radii.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

/// A strip from x = -1 over 3 to 4, then a single segment from 10 to 11; red, the normal and u are
/// the x.
Scene two_lines() {
    Scene scene;
    for (const float x : {-1.0F, 3.0F, 4.0F, 10.0F, 11.0F}) {
        scene.curve_points.insert(scene.curve_points.end(), {x, 0, 0, 0});
        scene.attributes.insert(scene.attributes.end(), {x, 1, 1, 1});
    }
    for (const float x : {-1.0F, 3.0F, 4.0F, 10.0F, 11.0F})
        scene.attributes.insert(scene.attributes.end(), {x, 2, 3});  // a normal
    for (const float x : {-1.0F, 3.0F, 4.0F, 10.0F, 11.0F})
        scene.attributes.insert(scene.attributes.end(), {x, 5});  // texture coordinates
    scene.curve_segments = {0, 1, 3};
    for (const int32_t first : {0, 2}) {
        Primitive primitive;
        primitive.geometry = static_cast<int32_t>(GeometryKind::curves);
        primitive.first_triangle = first;
        primitive.triangle_count = first == 0 ? 2 : 1;
        primitive.color_base = 0;
        primitive.normal_base = 20;
        primitive.uv_base[2] = 35;
        scene.primitives.push_back(primitive);
    }
    scene.materials.emplace_back();
    return scene;
}

float red_of(const Scene& scene, const Primitive& primitive, uint32_t point) {
    return scene
        .attributes[static_cast<size_t>(primitive.color_base + static_cast<int32_t>(point) * 4)];
}

TEST(SplitCurves, ASegmentThatPassesThePlaneBecomesTwo) {
    Scene scene = two_lines();
    split_curves(scene, [](const Vec3d& p) { return p.x; });
    EXPECT_EQ(scene.curve_segments, (std::vector<uint32_t>{0, 1, 2, 4}));
    EXPECT_EQ(scene.curve_points[4], 0.0F);
    EXPECT_EQ(scene.curve_points[8], 3.0F);
    EXPECT_EQ(scene.primitives[0].triangle_count, 3);
    EXPECT_EQ(scene.primitives[1].first_triangle, 3);
    EXPECT_EQ(scene.primitives[1].triangle_count, 1);
    for (const Primitive& primitive : scene.primitives) {
        for (int32_t i = 0; i < primitive.triangle_count; ++i) {
            const auto index = static_cast<size_t>(primitive.first_triangle + i);
            const uint32_t from = scene.curve_segments[index];
            EXPECT_EQ(red_of(scene, primitive, from), scene.curve_points[size_t{from} * 4]);
            EXPECT_EQ(red_of(scene, primitive, from + 1), scene.curve_points[size_t{from} * 4 + 4]);
            const auto normal =
                static_cast<size_t>(primitive.normal_base + static_cast<int32_t>(from) * 3);
            EXPECT_EQ(scene.attributes[normal], scene.curve_points[size_t{from} * 4]);
            EXPECT_EQ(scene.attributes[normal + 2], 3);
            const auto uv =
                static_cast<size_t>(primitive.uv_base[2] + static_cast<int32_t>(from) * 2);
            EXPECT_EQ(scene.attributes[uv], scene.curve_points[size_t{from} * 4]);
            EXPECT_EQ(scene.attributes[uv + 1], 5);
        }
    }
}

TEST(SplitCurves, LinesOnOneSideStay) {
    Scene scene = two_lines();
    split_curves(scene, [](const Vec3d& p) { return p.x + 1; });
    EXPECT_EQ(scene.curve_points, two_lines().curve_points);
    EXPECT_EQ(scene.primitives[1].color_base, 0);
}

TEST(SplitCurves, LongThinSegmentsBecomeShortOnes) {
    Scene scene = two_lines();
    for (size_t point = 0; point < 5; ++point)
        scene.curve_points[point * 4 + 3] = 0.00501F;
    scene.curve_points[7] = 0.00701F;  // the first segment is 4 long: 798 of its least radii
    split_long_curves(scene);
    EXPECT_EQ(scene.curve_segments, (std::vector<uint32_t>{0, 1, 2, 4}));
    EXPECT_EQ(scene.curve_points[4], 1.0F);
    EXPECT_FLOAT_EQ(scene.curve_points[7], 0.00601F);
    EXPECT_EQ(red_of(scene, scene.primitives[0], 1), 1.0F);
    for (float* at = scene.curve_points.data(); at < &scene.curve_points.back(); at += 4)
        at[3] = 1e-18F;
    split_long_curves(scene);
    EXPECT_EQ(scene.curve_segments.size(), 4 * 64U);
}

TEST(PointsLinesRadii, ShapesKeepTheirs) {
    Scene scene = two_lines();
    scene.spheres.assign(2 * sphere_block_floats, 7.0F);
    for (const bool shape : {true, false}) {
        Primitive primitive;
        primitive.geometry = static_cast<int32_t>(GeometryKind::spheres);
        primitive.first_triangle = shape ? 0 : sphere_block;
        primitive.triangle_count = 2;
        if (shape) primitive.tangent_base = 0;
        scene.primitives.push_back(primitive);
    }
    set_points_lines_radii(
        scene, [](const Vec3d& p) { return p.y; }, [](const Vec3d& p) { return p.x; });
    EXPECT_EQ(scene.curve_points[7], 3.0F);
    EXPECT_EQ(scene.curve_points[3], 1e-18F) << "never 0 or less";
    scene.spheres[sphere_word(size_t{1}) + sphere_block] = 2.5F;
    set_points_lines_radii(
        scene, [](const Vec3d& p) { return p.y; }, [](const Vec3d& p) { return p.x; });
    EXPECT_EQ(scene.spheres[sphere_word(size_t{1}) + 3 * sphere_block], 7.0F);
    EXPECT_EQ(scene.spheres[sphere_word(size_t{sphere_block}) + 3 * sphere_block], 7.0F);
    scene.spheres[sphere_word(size_t{sphere_block} + 1) + sphere_block] = 2.5F;
    set_points_lines_radii(
        scene, [](const Vec3d& p) { return p.y; }, [](const Vec3d& p) { return p.x; });
    EXPECT_EQ(scene.spheres[sphere_word(size_t{sphere_block} + 1) + 3 * sphere_block], 2.5F);
    EXPECT_EQ(scene.spheres[sphere_word(size_t{sphere_block} + 2) + 3 * sphere_block], 7.0F);
}

}  // namespace
}  // namespace obscura
