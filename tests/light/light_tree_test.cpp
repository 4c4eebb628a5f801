// tests/light/light_tree_test.cpp - choosing lights by a tree: probabilities, order, lanes.
// SPDX-License-Identifier: Apache-2.0
#include "light/light_tree.h"

#include "light/direction_cone.h"
#include "math/warp.h"

#include <gtest/gtest.h>

#include "support/chi_square.h"
#include "support/lane_arrays.h"
#include "support/random.h"
#include <cmath>
#include <cstring>

namespace obscura::test {
namespace {

Vec3f random_point(Pcg32& random, float size) {
    const auto one = [&] { return size * (2 * random.next_float() - 1); };
    const float x = one();
    const float y = one();
    return {x, y, one()};
}

Vec3f random_direction(Pcg32& random) {
    const float x = random.next_float();
    return uniform_sphere(Vec2f{x, random.next_float()});
}

/// Points and small surfaces in a box of side 4, some of one side.
std::vector<BoundedLight> random_lights(size_t count, uint64_t seed) {
    Pcg32 random(seed);
    std::vector<BoundedLight> lights(count);
    for (size_t i = 0; i < count; ++i) {
        BoundedLight& light = lights[i];
        const Vec3f place = random_point(random, 2);
        light.low = light.high = place;
        std::copy_n(&place.x, 3, light.bounds.centre);
        light.bounds.intensity = std::exp2(8 * random.next_float());
        light.light = static_cast<int32_t>(i);
        if (i % 3 == 0) continue;
        const Vec3f normal = random_direction(random);
        std::copy_n(&normal.x, 3, light.bounds.axis);
        light.bounds.cos_normals = 1;
        light.bounds.sides = i % 3 == 1 ? 1 : 0;
    }
    return lights;
}

LightTreeView view_of(const LightTree& tree) {
    LightTreeView view;
    view.nodes = tree.nodes.data();
    view.light_of_leaf = tree.light_of_leaf.data();
    view.leaf_of_light = tree.leaf_of_light.data();
    view.leaves = static_cast<int32_t>(tree.light_of_leaf.size());
    view.randoms = 1 << 30;
    view.share = 1;
    return view;
}

double probability(const LightTreeView& view, const LitPoint<float>& at, size_t light) {
    return static_cast<double>(
        light_tree_probability<float>(view, at, view.leaf_of_light[light], true));
}

constexpr Vec3f no_normal{0, 0, 0};

TEST(LightTree, EveryLightHasOneLeaf) {
    for (const size_t count : {2U, 3U, 17U, 1000U}) {
        const LightTree tree = build_light_tree(random_lights(count, count), count + 2);
        ASSERT_EQ(tree.light_of_leaf.size(), count);
        ASSERT_EQ(tree.nodes.size(), count - 1);
        ASSERT_EQ(tree.leaf_of_light.size(), count + 2);
        for (size_t i = 0; i < count; ++i) {
            const auto leaf = static_cast<size_t>(tree.leaf_of_light[i]);
            EXPECT_EQ(tree.light_of_leaf[leaf], static_cast<int32_t>(i));
        }
        EXPECT_EQ(tree.leaf_of_light[count], -1) << "not in the tree";
    }
}

TEST(LightTree, LightsAtOnePlaceAreSharedOut) {
    std::vector<BoundedLight> lights(100);
    for (size_t i = 0; i < lights.size(); ++i) {
        lights[i].light = static_cast<int32_t>(i);
        lights[i].low = lights[i].high = {0, 0, 0};
        lights[i].bounds.intensity = 1;
    }
    const LightTree tree = build_light_tree(lights, lights.size());
    for (size_t i = 0; i < lights.size(); ++i)
        EXPECT_NEAR(probability(view_of(tree), {{1, 2, 3}, no_normal}, i), 0.01, 1e-5);
}

TEST(LightTree, TheSameLightsGiveTheSameTree) {
    const auto lights = random_lights(500, 9);
    const LightTree a = build_light_tree(lights, lights.size());
    const LightTree b = build_light_tree(lights, lights.size());
    EXPECT_EQ(a.light_of_leaf, b.light_of_leaf);
    EXPECT_EQ(std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(LightTreeNode)),
              0);
}

/// Where light is seen from all sides, and lights shine in all directions, no draw is lost.
TEST(LightTree, ProbabilitiesSumToOne) {
    Pcg32 random(4);
    for (const size_t count : {2U, 16U, 300U}) {
        auto lights = random_lights(count, 7);
        for (BoundedLight& light : lights) {
            light.bounds.cos_normals = -1;
            light.bounds.sides = 0;
        }
        const LightTree tree = build_light_tree(lights, count);
        for (int k = 0; k < 50; ++k) {
            const LitPoint<float> at{random_point(random, 4), no_normal};
            double sum = 0;
            for (size_t i = 0; i < count; ++i)
                sum += probability(view_of(tree), at, i);
            EXPECT_NEAR(sum, 1, 1e-4) << count << " lights";
        }
    }
}

TEST(LightTree, NoLightIsLostBesideAVeryStrongOne) {
    for (const float strength : {1e3f, 1e9f, 1e15f, 1e30f}) {
        for (const size_t strong : {0U, 17U, 299U}) {
            auto lights = random_lights(300, 11);
            for (BoundedLight& light : lights)
                light.bounds.sides = light.bounds.cos_normals > 0 ? 1 : light.bounds.sides;
            lights[strong].bounds.intensity *= strength;
            const LightTree tree = build_light_tree(lights, lights.size());
            const LitPoint<float> at{{0.3f, -0.2f, 0.1f}, no_normal};
            for (size_t i = 0; i < lights.size(); ++i)
                EXPECT_GE(probability(view_of(tree), at, i), 0x1p-30) << i << " of " << strength;
        }
    }
}

/// The first of the random numbers, in units of four, that leads to a leaf from this one on.
int32_t first_number(const LightTreeView& view, const LitPoint<float>& at, int32_t leaf) {
    int32_t low = 0;
    int32_t high = view.randoms;
    while (low < high) {
        const int32_t middle = low + (high - low) / 2;
        const auto drawn =
            draw_from_light_tree<float>(view, at, static_cast<uint32_t>(middle) << 2U, true);
        const bool before = view.leaf_of_light[drawn.light] < leaf;
        (before ? low : high) = before ? middle + 1 : middle;
    }
    return low;
}

TEST(LightTree, TheProbabilityIsThatOfTheDescentExactly) {
    constexpr size_t count = 90;
    const LightTree tree = build_light_tree(random_lights(count, 51), count);
    const LightTreeView view = view_of(tree);
    Pcg32 random(52);
    double lit = 0;
    for (int k = 0; k < 10; ++k) {
        const LitPoint<float> at{random_point(random, 3),
                                 k % 2 == 0 ? no_normal : random_direction(random)};
        int32_t first = first_number(view, at, 0);
        ASSERT_EQ(first, 0);
        for (int32_t leaf = 0; leaf < view.leaves; ++leaf) {
            const int32_t end = first_number(view, at, leaf + 1);
            const float told = light_tree_probability<float>(view, at, leaf, true);
            // Numbers that end where no light brings anything lead to the last leaf there.
            if (told > 0) {
                EXPECT_EQ(told, static_cast<float>(end - first) * 0x1p-30f);
            }
            lit += static_cast<double>(told);
            first = end;
        }
        ASSERT_EQ(first, view.randoms);
    }
    EXPECT_GT(lit, 5) << "most of the ten points are lit";
}

/// Elsewhere the rest are draws that end where no light brings anything.
TEST(LightTree, LightsAreDrawnWithTheProbabilitiesThatTheTreeTells) {
    constexpr size_t count = 60;
    const auto lights = random_lights(count, 11);
    const LightTree tree = build_light_tree(lights, count);
    const LightTreeView view = view_of(tree);
    Pcg32 random(12);
    constexpr int points = 8;
    for (int k = 0; k < points; ++k) {
        const LitPoint<float> at{random_point(random, 3),
                                 k % 2 == 0 ? no_normal : random_direction(random)};
        constexpr int draws = 200000;
        std::vector<double> observed(count + 1, 0.0);
        std::vector<double> expected(count + 1, 0.0);
        for (int d = 0; d < draws; ++d) {
            const auto drawn = draw_from_light_tree<float>(view, at, random.next_uint(), true);
            const auto light = static_cast<size_t>(drawn.light);
            if (drawn.probability > 0) {
                ASSERT_EQ(static_cast<double>(drawn.probability), probability(view, at, light));
            }
            observed[drawn.probability > 0 ? light : count] += 1;
        }
        double rest = 1;
        for (size_t i = 0; i < count; ++i) {
            const double p = probability(view, at, i);
            expected[i] = draws * p;
            rest -= p;
        }
        expected[count] = draws * std::max(rest, 0.0);
        const ChiSquareOutcome outcome = chi_square(observed, expected);
        EXPECT_TRUE(outcome.passes(sidak_alpha(0.01, points))) << outcome;
    }
}

/// As of a CDF: so that stratified numbers choose stratified lights, and places on them.
TEST(LightTree, LeavesAndPlacesGrowWithTheRandomNumber) {
    const auto lights = random_lights(200, 21);
    const LightTree tree = build_light_tree(lights, lights.size());
    const LitPoint<float> at{{0.3f, 0.1f, -0.2f}, no_normal};
    int32_t last_leaf = -1;
    float last_place = 0;
    double covered = 0;
    for (uint32_t i = 0; i < 1U << 16; ++i) {
        const auto drawn = draw_from_light_tree<float>(view_of(tree), at, i << 16, true);
        const int32_t leaf = tree.leaf_of_light[static_cast<size_t>(drawn.light)];
        ASSERT_GE(leaf, last_leaf);
        ASSERT_GE(drawn.place, 0);
        ASSERT_LT(drawn.place, 1);
        if (leaf == last_leaf) {
            ASSERT_GE(drawn.place, last_place);
            covered += static_cast<double>(drawn.place - last_place) *
                       static_cast<double>(drawn.probability);
        }
        last_leaf = leaf;
        last_place = drawn.place;
    }
    EXPECT_GT(covered, 0.9) << "places fill the interval, but for steps between these numbers";
}

TEST(LightTree, LanesAgreeWithScalarsAndWithWhatMisAsksFor) {
    const auto lights = random_lights(333, 31);
    const LightTree tree = build_light_tree(lights, lights.size());
    const LightTreeView view = view_of(tree);
    Pcg32 random(32);
    for (int k = 0; k < 200; ++k) {
        LitPoint<float> at[16];
        uint32_t numbers[16];
        float columns[6][16];
        for (int i = 0; i < lane_count; ++i) {
            at[i] = {random_point(random, 3), i % 2 == 0 ? no_normal : random_direction(random)};
            numbers[i] = random.next_uint();
            const float values[6] = {at[i].position.x,
                                     at[i].position.y,
                                     at[i].position.z,
                                     at[i].normal.x,
                                     at[i].normal.y,
                                     at[i].normal.z};
            for (int c = 0; c < 6; ++c)
                columns[c][i] = values[c];
        }
        const LitPoint<Lanes> points{{load(columns[0]), load(columns[1]), load(columns[2])},
                                     {load(columns[3]), load(columns[4]), load(columns[5])}};
        const auto drawn = draw_from_light_tree<Lanes>(view, points, load(numbers), Mask(true));
        alignas(64) int32_t leaves[lane_count];
        for (int i = 0; i < lane_count; ++i)
            leaves[i] = tree.leaf_of_light[static_cast<size_t>(lane(drawn.light, i))];
        const auto told = light_tree_probability<Lanes>(view, points, load(leaves), Mask(true));
        for (int i = 0; i < lane_count; ++i) {
            const int32_t light = lane(drawn.light, i);
            const double p = probability(view, at[i], static_cast<size_t>(light));
            const float by_lane = lane(drawn.probability, i);
            EXPECT_NEAR(static_cast<double>(by_lane), p, 1e-3 * p + 1e-8);
            if (by_lane > 0) {
                EXPECT_EQ(by_lane, lane(told, i)) << "as MIS asks for it";
            }
        }
    }
}

TEST(DirectionCone, JoinedConesHoldBoth) {
    Pcg32 random(41);
    for (int k = 0; k < 2000; ++k) {
        const DirectionCone a{random_direction(random), 1.5f * random.next_float()};
        const DirectionCone b{random_direction(random), 1.5f * random.next_float()};
        const DirectionCone both = join(a, b);
        for (const DirectionCone& cone : {a, b}) {
            const float apart =
                std::atan2(length(cross(cone.axis, both.axis)), dot(cone.axis, both.axis));
            EXPECT_LE(apart + cone.half_angle, both.half_angle + 1e-3f);
        }
    }
}

}  // namespace
}  // namespace obscura::test
