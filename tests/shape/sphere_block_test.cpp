// tests/shape/sphere_block_test.cpp - one ray against sixteen spheres equals one after the other.
// SPDX-License-Identifier: Apache-2.0
#include "shape/sphere_block.h"

#include "shape/shape_truth.h"

#include <gtest/gtest.h>

#include <limits>

namespace obscura {
namespace {

using namespace test;

struct Block {
    alignas(64) float numbers[sphere_block_floats];
    int count = sphere_block;

    Sphere<double> sphere(int i) const {
        return {{numbers[i], numbers[sphere_block + i], numbers[2 * sphere_block + i]},
                numbers[3 * sphere_block + i]};
    }
};

Block random_block(Pcg32& random, int count) {
    Block block;
    block.count = count;
    std::fill_n(block.numbers, sphere_block_floats, std::numeric_limits<float>::quiet_NaN());
    for (int i = 0; i < count; ++i) {
        for (int c = 0; c < 3; ++c)
            block.numbers[c * sphere_block + i] = 2.0F * random.next_float() - 1.0F;
        block.numbers[3 * sphere_block + i] = 0.1F + 0.3F * random.next_float();
    }
    return block;
}

void expect_nearest(const Block& block,
                    const ShapeRay<float>& ray,
                    bool front_only,
                    float distance) {
    const Span<float> limits{0.0F, no_limit};
    const BlockHit got = intersect_sphere_block(block.numbers, ray, limits, front_only);
    double nearest_t = 1e30;
    double clearest = 1e30;  ///< distance of the line to the closest outline
    const ShapeRay<double> wide = ray_cast_to<double>(ray);
    for (int i = 0; i < block.count; ++i) {
        const Sphere<double> sphere = block.sphere(i);
        Roots<double> roots = intersect_sphere(sphere, wide);
        if (front_only) roots.hit[1] = false;
        const NearHit<double> hit = nearest(roots, 0.0, nearest_t);
        if (hit.found) nearest_t = hit.t;
        const double passes = length(exact_cross(wide.origin - sphere.centre, wide.direction)) /
                              length(wide.direction);
        clearest = std::min(clearest, std::abs(passes - sphere.radius));
    }
    if (clearest < 1e-5) return;
    ASSERT_EQ(got.sphere >= 0, nearest_t < 1e29);
    if (got.sphere < 0) return;
    ASSERT_LT(got.sphere, block.count);
    const double size = static_cast<double>(length(ray.direction));
    ASSERT_NEAR(
        got.t * size, nearest_t * size, 2e-6 * (3.0 + static_cast<double>(distance)) + 2e-4);
}

TEST(SphereBlock, FindsTheNearestOfAll) {
    Pcg32 random(31);
    const ShapeRecord aim = shape_record(ShapeKind::sphere, 1, 0, 0);
    for (int i = 0; i < 20000; ++i) {
        const Block block = random_block(random, i % 3 == 0 ? 5 : sphere_block);
        const float distance = i % 4 == 0 ? 0.0F : i % 4 == 1 ? 1e5F : 4.0F;
        const ShapeRay<float> ray = random_ray(aim, distance, random);
        ASSERT_NO_FATAL_FAILURE(expect_nearest(block, ray, i % 2 == 0, distance));
    }
}

TEST(SphereBlock, WordsOfASphereLieInItsBlock) {
    EXPECT_EQ(sphere_word(0), 0);
    EXPECT_EQ(sphere_word(15), 15);
    EXPECT_EQ(sphere_word(16), sphere_block_floats);
    EXPECT_EQ(sphere_word(35), 2 * sphere_block_floats + 3);
}

}  // namespace
}  // namespace obscura
