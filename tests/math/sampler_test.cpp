// tests/math/sampler_test.cpp - stratification, uniformity and independence of the random numbers.
// SPDX-License-Identifier: Apache-2.0
#include "math/sampler.h"

#include <gtest/gtest.h>

#include "support/chi_square.h"
#include "support/lane_arrays.h"
#include <bit>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace obscura {
namespace {

using test::lane;
using test::make_lanes;

constexpr uint32_t pairs_tested = 3 * pairs_per_bounce;

Vec2<uint32_t> point(uint32_t key, uint32_t sample, uint32_t pair) {
    return sobol_pair(key, reverse_bits(sample), pair);
}

uint32_t key_of(uint32_t x, uint32_t y) {
    return pixel_key(x, y, 0U, 0U);
}

uint32_t top_bits(uint32_t word, int bits) {
    return bits == 0 ? 0U : word >> (32 - bits);
}

/// Every box of 2^-a by 2^-(k-a) holds exactly one of the 2^k points from `first` on.
bool is_stratified(uint32_t key, uint32_t pair, uint32_t first, int k) {
    const uint32_t count = 1U << k;
    for (int a = 0; a <= k; ++a) {
        std::vector<bool> taken(count, false);
        for (uint32_t i = 0; i < count; ++i) {
            const Vec2<uint32_t> p = point(key, first + i, pair);
            const uint32_t box = top_bits(p.x, a) << (k - a) | top_bits(p.y, k - a);
            if (taken[box]) return false;
            taken[box] = true;
        }
    }
    return true;
}

TEST(Sampler, EveryPairFillsAllElementaryIntervals) {
    for (uint32_t pixel = 0; pixel < 8; ++pixel) {
        const uint32_t key = key_of(pixel * 37U, pixel);
        for (uint32_t pair = 0; pair < pairs_tested; ++pair) {
            for (int k = 0; k <= 8; ++k) {
                ASSERT_TRUE(is_stratified(key, pair, 0, k)) << "pair " << pair << ", 2^" << k;
            }
        }
        ASSERT_TRUE(is_stratified(key, 1, 0, 12));
    }
}

TEST(Sampler, AlignedRunsOfSamplesAreStratifiedToo) {
    for (uint32_t pair = 0; pair < pairs_per_bounce; ++pair) {
        for (const uint32_t first : {64U, 4096U, 1U << 20, 0xFFFFFFC0U}) {
            ASSERT_TRUE(is_stratified(key_of(5, 9), pair, first, 6)) << first;
        }
    }
}

/// Every box of equal size, as flat or tall as they come, holds one of the points of the pixels
/// [x, x + side) x [y, y + side).
bool is_stratified_over_pixels(uint32_t x, uint32_t y, uint32_t side, int bits, uint32_t pair) {
    std::vector<Vec2<uint32_t>> points;
    for (uint32_t i = 0; i < side * side; ++i) {
        const auto [key, first] = z_order_sequence(x + i % side, y + i / side, 7U, 0U, bits);
        for (uint32_t sample = 0; sample < 1U << bits; ++sample)
            points.push_back(point(key, first + sample, pair));
    }
    const int k = std::countr_zero(points.size());
    for (int a = 0; a <= k; ++a) {
        std::set<uint32_t> boxes;
        for (const Vec2<uint32_t>& p : points)
            boxes.insert(top_bits(p.x, a) << (k - a) | top_bits(p.y, k - a));
        if (boxes.size() != points.size()) return false;
    }
    return true;
}

TEST(Sampler, PixelsInZOrderAreStratifiedTogether) {
    for (const int bits : {0, 1, 4}) {
        for (uint32_t pair = 0; pair < pairs_per_bounce; ++pair) {
            for (const uint32_t side : {1U, 2U, 4U, 8U}) {
                EXPECT_TRUE(is_stratified_over_pixels(3 * side, 64 + side, side, bits, pair));
                EXPECT_TRUE(is_stratified_over_pixels(0U - side, 0U - 3 * side, side, bits, pair))
                    << "left of the image and above it";
            }
        }
    }
    EXPECT_TRUE(is_stratified_over_pixels(64, 128, z_order_side, 0, 1));
}

TEST(Sampler, PixelsInZOrderShareNoNumber) {
    std::set<std::pair<uint32_t, uint32_t>> runs;
    for (uint32_t i = 0; i < 128 * 128; ++i) {
        const auto [key, first] = z_order_sequence(i % 128, i / 128, 7U, 0U, 20);
        EXPECT_EQ(first % (1U << 20), 0U);
        runs.insert({key, first});
    }
    EXPECT_EQ(runs.size(), size_t{128} * 128);
}

/// p-value of the points of many pixels over 16 x 16 boxes.
template <typename Point>
double p_value_of_boxes(int count, const Point& point_of) {
    constexpr int side = 16;
    std::vector<double> observed(side * side, 0.0);
    const std::vector<double> expected(side * side, static_cast<double>(count) / (side * side));
    for (int i = 0; i < count; ++i) {
        const Vec2<uint32_t> p = point_of(static_cast<uint32_t>(i));
        observed[top_bits(p.x, 4) * side + top_bits(p.y, 4)] += 1;
    }
    return chi_square(observed, expected).p_value;
}

TEST(Sampler, EachSampleIsUniformOverThePixels) {
    constexpr int samples = 8;
    const double alpha = sidak_alpha(0.01, samples * static_cast<int>(pairs_per_bounce));
    for (uint32_t pair = 0; pair < pairs_per_bounce; ++pair) {
        for (uint32_t sample = 0; sample < samples; ++sample) {
            const double p = p_value_of_boxes(
                1 << 16, [&](uint32_t i) { return point(key_of(i % 256, i / 256), sample, pair); });
            EXPECT_GT(p, alpha) << "pair " << pair << ", sample " << sample;
        }
    }
}

/// Two numbers that should be independent, as one point.
template <typename First, typename Second>
void expect_independent(const First& first, const Second& second, const char* what) {
    constexpr int count = 1 << 17;
    const double p = p_value_of_boxes(count, [&](uint32_t i) {
        return Vec2<uint32_t>{first(i), second(i)};
    });
    EXPECT_GT(p, 1e-4) << what;
    double covariance = 0;
    for (uint32_t i = 0; i < count; ++i)
        covariance += (first(i) * 0x1p-32 - 0.5) * (second(i) * 0x1p-32 - 0.5);
    EXPECT_LT(std::abs(covariance / count * 12), 4 / std::sqrt(static_cast<double>(count))) << what;
}

TEST(Sampler, DifferentPairsAreIndependent) {
    // One sample a pixel: within one pixel all samples are stratified, hence not independent.
    const auto of_pair = [](uint32_t pair, bool y) {
        return [=](uint32_t i) {
            const Vec2<uint32_t> p = point(key_of(i % 512, i / 512), 3, pair);
            return y ? p.y : p.x;
        };
    };
    for (uint32_t pair = 1; pair < pairs_tested; ++pair) {
        expect_independent(of_pair(0, false), of_pair(pair, false), "pair 0 x, another x");
        expect_independent(of_pair(pair - 1, true), of_pair(pair, true), "neighbours y");
        expect_independent(of_pair(pair - 1, false), of_pair(pair, true), "neighbours x, y");
    }
}

TEST(Sampler, DifferentPixelsAreIndependent) {
    const auto of_pixel = [](uint32_t dx, uint32_t dy) {
        return [=](uint32_t i) { return point(key_of(i % 512 + dx, i / 512 + dy), 0, 1).x; };
    };
    expect_independent(of_pixel(0, 0), of_pixel(1, 0), "right neighbour");
    expect_independent(of_pixel(0, 0), of_pixel(0, 1), "lower neighbour");
    expect_independent(of_pixel(0, 0), of_pixel(1, 1), "diagonal neighbour");
    expect_independent(of_pixel(0, 0), of_pixel(32, 0), "next tile");
}

TEST(Sampler, SamplesOfDifferentPairsMixWithinAPixel) {
    // Points from two pairs' first numbers: equal shuffles would draw lines.
    constexpr uint32_t samples = 1024;
    constexpr double cells = 64;
    double worst = 0;
    for (uint32_t pixel = 0; pixel < 100; ++pixel) {
        const uint32_t key = key_of(pixel, 77);
        std::vector<double> observed(64, 0.0);
        for (uint32_t i = 0; i < samples; ++i) {
            const uint32_t a = point(key, i, 1).x;
            const uint32_t b = point(key, i, 2).x;
            observed[top_bits(a, 3) * 8 + top_bits(b, 3)] += 1;
        }
        double statistic = 0;
        for (const double n : observed)
            statistic += (n - samples / cells) * (n - samples / cells) / (samples / cells);
        worst = std::max(worst, statistic);
    }
    EXPECT_LT(worst, 130) << "chi-square of 49 degrees, the largest of 100";
}

TEST(Sampler, SeedPixelAndPairAllMatter) {
    const uint32_t keys[] = {pixel_key(3U, 4U, 5U, 6U),
                             pixel_key(4U, 3U, 5U, 6U),
                             pixel_key(3U, 5U, 5U, 6U),
                             pixel_key(3U, 4U, 6U, 5U),
                             pixel_key(3U, 4U, 6U, 6U),
                             pixel_key(3U, 4U, 5U, 7U),
                             pixel_key(3U, 4U, 0x80000005U, 6U),
                             pixel_key(3U, 4U, 5U, 0x80000006U)};
    EXPECT_EQ(std::set<uint32_t>(std::begin(keys), std::end(keys)).size(), std::size(keys));
    std::set<uint32_t> values;
    for (uint32_t pair = 0; pair < 100; ++pair)
        values.insert(point(keys[0], 0, pair).x);
    EXPECT_EQ(values.size(), 100U);
}

TEST(Sampler, NoSeedIsAnotherSeedsImageMoved) {
    // Averages of images with seeds 0, 1, 2 ... would have correlated neighbours.
    std::set<uint32_t> keys;
    for (uint32_t seed = 0; seed < 16; ++seed) {
        for (uint32_t x = 0; x < 64; ++x) {
            for (uint32_t y = 0; y < 64; ++y)
                keys.insert(pixel_key(x, y, seed, 0U));
        }
    }
    EXPECT_GE(keys.size(), 16U * 64U * 64U - 4U) << "chance meetings are rare";
}

TEST(Sampler, HashSpreadsEveryBit) {
    Pcg32 random(9);
    for (int bit = 0; bit < 32; ++bit) {
        int flipped = 0;
        for (int n = 0; n < 1000; ++n) {
            const uint32_t x = random.next_uint();
            flipped += __builtin_popcount(hash_word(x) ^ hash_word(x ^ (1U << bit)));
        }
        EXPECT_NEAR(flipped / 1000.0, 16.0, 0.5) << "bit " << bit;
    }
}

TEST(Sampler, LanesAreTheScalarsBitForBit) {
    Pcg32 random(4);
    for (int n = 0; n < 2000; ++n) {
        const LanesU x = make_lanes([&](int) { return random.next_uint() >> 16; });
        const LanesU y = make_lanes([&](int) { return random.next_uint() >> 16; });
        const LanesU sample = make_lanes([&](int) { return random.next_uint() >> 12; });
        const uint32_t low = random.next_uint();
        const uint32_t high = random.next_uint();
        const uint32_t pair = random.next_uint() % 100;
        const int bits_below = static_cast<int>(pair % 20);
        const PixelSequence<LanesU> along =
            z_order_sequence(LanesU(0U) - x, y, low, high, bits_below);
        const LanesU key = pixel_key(x, y, low, high);
        const Vec2<LanesU> bits = sobol_pair(key, reverse_bits(sample), pair);
        const Vec2<Lanes> u = unit_pair<Lanes>(bits);
        for (int i = 0; i < lane_count; ++i) {
            const uint32_t one = pixel_key(lane(x, i), lane(y, i), low, high);
            ASSERT_EQ(lane(key, i), one);
            const PixelSequence<uint32_t> alone =
                z_order_sequence(0U - lane(x, i), lane(y, i), low, high, bits_below);
            ASSERT_EQ(lane(along.key, i), alone.key);
            ASSERT_EQ(lane(along.first, i), alone.first);
            const Vec2<uint32_t> p = point(one, lane(sample, i), pair);
            ASSERT_EQ(lane(bits.x, i), p.x);
            ASSERT_EQ(lane(bits.y, i), p.y);
            ASSERT_EQ(lane(u.x, i), unit_float<float>(p.x));
            ASSERT_EQ(lane(u.y, i), unit_float<float>(p.y));
        }
    }
}

TEST(Sampler, UnitFloatStaysBelowOne) {
    EXPECT_EQ(unit_float<float>(0U), 0.0F);
    EXPECT_EQ(unit_float<float>(0x80000000U), 0.5F);
    EXPECT_EQ(unit_float<float>(0xFFFFFFFFU), std::nextafter(1.0F, 0.0F));
    EXPECT_EQ(lane(unit_float<Lanes>(LanesU(0xFFFFFFFFU)), 0), std::nextafter(1.0F, 0.0F));
    EXPECT_EQ(unit_float<double>(0xFFFFFFFFU), 1.0 - 0x1p-24);
}

}  // namespace
}  // namespace obscura
