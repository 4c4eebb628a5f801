// tests/gltf/particles_test.cpp - the order of spheres in blocks, and that poses keep it.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/particles.h"

#include "shape/sphere_cluster.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include <algorithm>
#include <numeric>

namespace obscura::gltf {
namespace {

std::vector<float> random_places(size_t count, uint64_t seed) {
    Pcg32 random(seed);
    std::vector<float> out(3 * count);
    for (float& x : out)
        x = random.next_float();
    return out;
}

/// Sum of the volumes of the boxes around every `part` spheres in this order.
double volume(const std::vector<float>& places, const std::vector<uint32_t>& order, size_t part) {
    double sum = 0;
    for (size_t first = 0; first < order.size(); first += part) {
        double product = 1;
        for (size_t c = 0; c < 3; ++c) {
            float low = 1;
            float high = 0;
            for (size_t i = first; i < std::min(first + part, order.size()); ++i) {
                low = std::min(low, places[3 * order[i] + c]);
                high = std::max(high, places[3 * order[i] + c]);
            }
            product *= static_cast<double>(high - low);
        }
        sum += product;
    }
    return sum;
}

TEST(SphereOrders, HoldEverySphereOnceInSmallBlocks) {
    for (const size_t count : {size_t{1}, size_t{16}, size_t{17}, size_t{1000}, size_t{20001}}) {
        const std::vector<float> places = random_places(count, count);
        SphereOrders orders;
        const std::vector<uint32_t>& order = orders.order_of(places);
        std::vector<uint32_t> sorted = order;
        std::sort(sorted.begin(), sorted.end());
        std::vector<uint32_t> all(count);
        std::iota(all.begin(), all.end(), 0U);
        EXPECT_EQ(sorted, all);
        if (count < 20000) continue;
        // Blocks of 16 of 20000 in a cube would best be cubes of 16 / 20000 of it.
        EXPECT_LT(volume(places, order, sphere_block), 1.0);
        EXPECT_LT(volume(places, order, cluster_spheres), 1.2);
        EXPECT_GT(volume(places, all, sphere_block), 100);
    }
}

TEST(SphereOrders, AreFoundAgainInTheNextPose) {
    const std::vector<float> still = random_places(5000, 1);
    const std::vector<float> moving = random_places(5000, 2);
    SphereOrders orders;
    const uint32_t* kept = orders.order_of(still).data();
    const std::vector<uint32_t> first = orders.order_of(still);
    orders.begin_pose();
    const std::vector<uint32_t> other = orders.order_of(moving);
    EXPECT_EQ(orders.order_of(still).data(), kept);
    EXPECT_EQ(orders.order_of(still), first);
    EXPECT_NE(other, first);
    EXPECT_EQ(SphereOrders().order_of(moving), other);
    Scene alone;
    Scene shared;
    EXPECT_EQ(append_spheres(still, {1}, alone).order, first);
    append_spheres(still, {1}, shared, &orders);
    EXPECT_TRUE(std::equal(
        alone.spheres.begin(), alone.spheres.end(), shared.spheres.begin(), [](float a, float b) {
            return a == b || (a != a && b != b);
        }));
}

}  // namespace
}  // namespace obscura::gltf
