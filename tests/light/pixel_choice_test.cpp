// tests/light/pixel_choice_test.cpp - drawing a pixel: probabilities, positions, odd maps, lanes.
// SPDX-License-Identifier: Apache-2.0
#include "light/pixel_choice.h"

#include <gtest/gtest.h>

#include "support/chi_square.h"
#include "support/random.h"
#include <cmath>
#include <numeric>

namespace obscura {
namespace {

/// A map's weights with its tables, and the resulting probabilities.
struct Choice {
    int width, height;
    std::vector<double> weights, told;
    PixelChoice tables;

    Choice(int width_in, int height_in, std::vector<double> weights_in)
        : width(width_in),
          height(height_in),
          weights(std::move(weights_in)),
          told(weights.size(), -1.0) {
        tables.build(
            width,
            height,
            [&](int x, int y) { return weights[number(x, y)]; },
            [&](int x, int y, double probability) { told[number(x, y)] = probability; });
    }

    size_t number(int x, int y) const {
        return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
    }

    PixelDraw<float> draw(uint32_t x, uint32_t y) const {
        PixelDraw<float> draw = draw_block<float>(tables.view(), {x, y});
        draw_pixel(tables.view(), draw);
        return draw;
    }
};

/// A fifth of them 0, the others from 1 to 2^`range`.
std::vector<double> random_weights(size_t count, uint64_t seed, double range) {
    Pcg32 random(seed);
    std::vector<double> weights(count);
    for (double& weight : weights) {
        const double u = random.next_double();
        weight = u < 0.2 ? 0.0 : std::exp2(range * u);
    }
    return weights;
}

Choice random_choice(int width, int height, double range = 20) {
    const auto count = static_cast<size_t>(width) * static_cast<size_t>(height);
    return {width, height, random_weights(count, count, range)};
}

double sum_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(PixelChoice, ProbabilitiesFollowTheWeights) {
    const int sizes[][2] = {{1, 1}, {1, 4}, {8, 8}, {9, 7}, {64, 32}, {33, 100}, {500, 3}};
    for (const auto& size : sizes) {
        const Choice choice = random_choice(size[0], size[1]);
        const double sum = sum_of(choice.weights);
        EXPECT_NEAR(sum_of(choice.told), 1.0, 1e-12);
        for (size_t i = 0; i < choice.weights.size(); ++i) {
            const double expected = choice.weights[i] / sum;
            EXPECT_NEAR(choice.told[i], expected, 64 * 0x1p-30 + 1e-12) << size[0] << ", " << i;
            EXPECT_EQ(choice.told[i] > 0, choice.weights[i] > 0) << size[0] << ", pixel " << i;
        }
    }
}

/// One pixel outshines all others by far: they are still drawn, with the right probability.
TEST(PixelChoice, TheFaintestPixelIsStillReached) {
    std::vector<double> weights(64 * 40, 1.0);
    weights[1000] = 1e12;
    const Choice choice(64, 40, weights);
    for (const double told : choice.told)
        EXPECT_GE(told, 0x1p-62);
    EXPECT_NEAR(choice.told[1000], 1.0, 1e-5);
}

TEST(PixelChoice, BlackMapsDrawPixelsOfTheMap) {
    const Choice choice(13, 9, std::vector<double>(13 * 9, 0.0));
    Pcg32 random(2);
    for (int i = 0; i < 1000; ++i) {
        const uint32_t x = random.next_uint();
        const auto draw = choice.draw(x, random.next_uint());
        EXPECT_TRUE(draw.column >= 0 && draw.column < 13 && draw.row >= 0 && draw.row < 9);
    }
}

/// Draws pixels, and within a pixel sixteen equal parts of what is left of both numbers.
TEST(PixelChoice, PixelAndRemainderAreIndependentAndRight) {
    constexpr int samples = 2000000;
    const Choice choice = random_choice(21, 13, 6);
    std::vector<double> observed(choice.weights.size() * 16, 0.0);
    Pcg32 random(11);
    for (int i = 0; i < samples; ++i) {
        const uint32_t x = random.next_uint();
        const auto draw = choice.draw(x, random.next_uint());
        const auto part = [](float left) {
            return static_cast<size_t>(std::min(left, 0.999F) * 4);
        };
        const size_t place = part(draw.left.x) * 4 + part(draw.left.y);
        observed[choice.number(draw.column, draw.row) * 16 + place] += 1;
    }
    std::vector<double> expected(observed.size());
    for (size_t i = 0; i < expected.size(); ++i)
        expected[i] = choice.told[i / 16] * samples / 16;
    const ChiSquareOutcome right = chi_square(observed, expected);
    EXPECT_TRUE(right.passes(0.01)) << right;

    for (size_t i = 0; i < 16; ++i)
        std::swap(expected[16 * 50 + i], expected[16 * 99 + i]);
    const ChiSquareOutcome wrong = chi_square(observed, expected);
    EXPECT_FALSE(wrong.passes(0.01)) << wrong;
}

/// The first and the last number, and those at the borders of blocks, lead to pixels with weight.
TEST(PixelChoice, BordersLeadToPixelsThatAreThere) {
    std::vector<double> weights = random_weights(40 * 24, 3, 10);
    std::fill(weights.begin(), weights.begin() + 40 * 8, 0.0);  // black blocks at one end
    const Choice choice(40, 24, weights);
    const PixelChoiceView view = choice.tables.view();
    std::vector<uint32_t> numbers = {0, 0xFFFFFFFFU};
    for (int block = 0; block < 15; ++block) {
        numbers.push_back(view.bounds[block]);
        numbers.push_back(view.bounds[block] + 1);
    }
    for (const uint32_t x : numbers) {
        for (uint32_t y = 0; y < 256; ++y) {
            const auto draw = choice.draw(x, y << 24 | y);
            ASSERT_TRUE(draw.column < 40 && draw.row < 24);
            EXPECT_GT(choice.weights[choice.number(draw.column, draw.row)], 0) << x << ", " << y;
            EXPECT_TRUE(draw.left.x >= 0 && draw.left.x <= 1) << x;
            EXPECT_TRUE(draw.left.y >= 0 && draw.left.y <= 1) << y;
        }
    }
}

/// Neighbouring numbers stay together: equal intervals of the first number lead to compact regions
/// of an even map.
TEST(PixelChoice, EqualPartsOfTheNumbersAreCompact) {
    constexpr uint32_t parts = 64;  // of 32 x 16 pixels each, were they rectangles
    const Choice choice(256, 128, std::vector<double>(256 * 128, 1.0));
    Pcg32 random(5);
    for (uint32_t part = 0; part < parts; ++part) {
        int low[2] = {256, 128};
        int high[2] = {0, 0};
        for (int i = 0; i < 200; ++i) {
            const uint32_t x = part << 26 | random.next_uint() >> 6;
            const auto draw = choice.draw(x, random.next_uint());
            const int at[2] = {draw.column, draw.row};
            for (int axis = 0; axis < 2; ++axis) {
                low[axis] = std::min(low[axis], at[axis]);
                high[axis] = std::max(high[axis], at[axis]);
            }
        }
        EXPECT_LE(high[0] - low[0], 40) << part;
        EXPECT_LE(high[1] - low[1], 40) << part;
    }
}

TEST(PixelChoice, LanesEqualScalars) {
    const Choice choice = random_choice(100, 60);
    Pcg32 random(1);
    for (int round = 0; round < 1000; ++round) {
        uint32_t bits[2][lane_count];
        for (auto& words : bits) {
            for (uint32_t& word : words)
                word = random.next_uint();
        }
        PixelDraw<Lanes> got =
            draw_block<Lanes>(choice.tables.view(), {load(bits[0]), load(bits[1])});
        draw_pixel(choice.tables.view(), got);
        int32_t at[2][lane_count];
        float left[2][lane_count];
        got.column.v.store_unaligned(at[0]);
        got.row.v.store_unaligned(at[1]);
        got.left.x.v.store_unaligned(left[0]);
        got.left.y.v.store_unaligned(left[1]);
        for (int i = 0; i < lane_count; ++i) {
            const auto one = choice.draw(bits[0][i], bits[1][i]);
            EXPECT_EQ(at[0][i], one.column);
            EXPECT_EQ(at[1][i], one.row);
            EXPECT_NEAR(left[0][i], one.left.x, 1e-6);
            EXPECT_NEAR(left[1][i], one.left.y, 1e-6);
        }
    }
}

}  // namespace
}  // namespace obscura
