// tests/shape/sphere_cluster_test.cpp - boxes around blocks of spheres, and rays that enter them.
// SPDX-License-Identifier: Apache-2.0
#include "shape/sphere_cluster.h"

#include "shape/shape_truth.h"

#include <gtest/gtest.h>

#include <limits>

namespace obscura {
namespace {

using namespace test;

struct Boxes {
    alignas(64) float numbers[cluster_floats];

    float& low(int c, int i) { return numbers[c * cluster_blocks + i]; }
    float& high(int c, int i) { return numbers[(3 + c) * cluster_blocks + i]; }
};

/// Boxes in a cube of 2 m; from `count` on there are none.
Boxes random_boxes(Pcg32& random, int count) {
    Boxes boxes;
    fill_cluster_boxes(nullptr, 0, boxes.numbers);
    for (int i = 0; i < count; ++i) {
        for (int c = 0; c < 3; ++c) {
            boxes.low(c, i) = 2.0F * random.next_float() - 1.0F;
            boxes.high(c, i) = boxes.low(c, i) + 0.5F * random.next_float();
        }
    }
    return boxes;
}

/// Where the ray enters and leaves a box.
Span<double> span_inside(Boxes& boxes, int i, const ShapeRay<float>& ray, double limit) {
    Span<double> way{0, limit};
    const float origin[3] = {ray.origin.x, ray.origin.y, ray.origin.z};
    const float direction[3] = {ray.direction.x, ray.direction.y, ray.direction.z};
    for (int c = 0; c < 3; ++c) {
        const auto at = [&](float side) {
            return (static_cast<double>(side) - static_cast<double>(origin[c])) /
                   static_cast<double>(direction[c]);
        };
        const double a = at(boxes.low(c, i));
        const double b = at(boxes.high(c, i));
        way = {std::max(way.low, std::min(a, b)), std::min(way.high, std::max(a, b))};
    }
    return way;
}

TEST(SphereCluster, NoBoxThatARayEntersIsPassedBy) {
    Pcg32 random(41);
    const ShapeRecord aim = shape_record(ShapeKind::sphere, 1, 0, 0);
    int entered = 0;
    for (int k = 0; k < 20000; ++k) {
        Boxes boxes = random_boxes(random, k % 3 == 0 ? 5 : cluster_blocks);
        const float distance = k % 4 == 0 ? 0.0F : k % 4 == 1 ? 1e5F : 4.0F;
        const ShapeRay<float> ray = random_ray(aim, distance, random);
        const float limit = k % 2 == 0 ? no_limit : (distance + 1) / length(ray.direction);
        const BoxEntries entries = enter_boxes(boxes.numbers, ray, {0, limit});
        for (int i = 0; i < cluster_blocks; ++i) {
            const Span<double> way = span_inside(boxes, i, ray, static_cast<double>(limit));
            const bool there = k % 3 != 0 || i < 5;
            const bool enters = (entries.bits >> i & 1U) != 0;
            ASSERT_TRUE(enters || !there || way.low > way.high) << k << " " << i;
            ASSERT_TRUE(!enters || (there && way.low <= way.high * (1 + 2e-6))) << k << " " << i;
            if (!enters) continue;
            ++entered;
            ASSERT_NEAR(static_cast<double>(entries.t[i]), way.low, 1e-6 * way.low);
        }
    }
    EXPECT_GT(entered, 4000);
}

TEST(SphereCluster, RaysAlongAxesEnterTheirBoxes) {
    Boxes boxes;
    fill_cluster_boxes(nullptr, 0, boxes.numbers);
    for (int c = 0; c < 3; ++c) {
        boxes.low(c, 3) = 1;
        boxes.high(c, 3) = 2;
    }
    const auto entered = [&](const Vec3f& origin, const Vec3f& direction) {
        return enter_boxes(boxes.numbers, {origin, direction}, {0, no_limit}).bits;
    };
    EXPECT_EQ(entered({1.5F, 1.5F, 0}, {0, 0, 1}), 1U << 3);
    EXPECT_EQ(entered({1.00001F, 1.99999F, 0}, {0, -0.0F, 1}), 1U << 3);
    EXPECT_EQ(entered({1.5F, 1.5F, 5}, {-0.0F, 0, -1}), 1U << 3);
    EXPECT_EQ(entered({0.5F, 1.5F, 0}, {0, 0, 1}), 0U);
    EXPECT_EQ(entered({1.5F, 1.5F, 5}, {0, 0, 1}), 0U);  // behind it
    EXPECT_EQ(entered({1.5F, 1.5F, 1.5F}, {0, 1, 0}), 1U << 3);
}

TEST(SphereCluster, TheNearestBoxComesFirst) {
    BoxEntries entries;
    entries.t[2] = 3;
    entries.t[7] = 1;
    entries.t[9] = 2;
    entries.t[11] = 1;
    EXPECT_EQ(first_entry(entries, 1U << 2 | 1U << 7 | 1U << 9 | 1U << 11), 7);
    EXPECT_EQ(first_entry(entries, 1U << 2 | 1U << 9), 9);
}

TEST(SphereCluster, BoxesHoldTheirBlocks) {
    std::vector<float> spheres(2 * sphere_block_floats, std::numeric_limits<float>::quiet_NaN());
    const float some[3][4] = {{0, 0, 0, 1}, {3, 0, -2, 0.5F}, {-7, 8, 9, 2}};
    for (size_t i = 0; i < 3; ++i) {
        const size_t index = i < 2 ? i : sphere_block;
        for (size_t c = 0; c < 4; ++c)
            spheres[sphere_word(index) + c * sphere_block] = some[i][c];
    }
    Boxes boxes;
    fill_cluster_boxes(spheres.data(), 2, boxes.numbers);
    const float sides[2][6] = {{-1, -1, -2.5F, 3.5F, 1, 1}, {-9, 6, 7, -5, 10, 11}};
    for (int i = 0; i < 2; ++i) {
        for (int side = 0; side < 6; ++side)
            EXPECT_NEAR(boxes.numbers[side * cluster_blocks + i], sides[i][side], 2e-5F);
    }
    EXPECT_GT(boxes.low(0, 2), boxes.high(0, 2));
    const ShapeBox all = cluster_bounds(boxes.numbers);
    EXPECT_NEAR(all.low.x, -9, 2e-5F);
    EXPECT_NEAR(all.low.z, -2.5F, 2e-5F);
    EXPECT_NEAR(all.high.x, 3.5F, 2e-5F);
    EXPECT_NEAR(all.high.y, 10, 2e-5F);
}

}  // namespace
}  // namespace obscura
