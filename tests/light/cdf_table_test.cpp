// tests/light/cdf_table_test.cpp - drawing an index: probabilities, limits, lanes.
// SPDX-License-Identifier: Apache-2.0
#include "light/cdf_table.h"

#include <gtest/gtest.h>

#include "support/chi_square.h"
#include "support/random.h"
#include <cmath>
#include <limits>
#include <numeric>

namespace obscura {
namespace {

std::vector<double> random_weights(size_t count, uint64_t seed) {
    Pcg32 random(seed);
    std::vector<double> weights(count);
    for (double& weight : weights) {
        const double u = random.next_double();
        weight = u < 0.2 ? 0.0 : std::exp2(20 * u);
    }
    return weights;
}

std::vector<CdfEntry> table_for(const std::vector<double>& weights) {
    return build_cdf_table(std::span<const double>(weights));
}

std::vector<double> shares_of(const std::vector<CdfEntry>& table) {
    return cdf_probabilities(std::span<const CdfEntry>(table));
}

/// Smallest fraction of the random numbers that an index can have.
constexpr double grain = 0x1p-32;

double sum_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(CdfTable, MultiplyHighIsTheUpperHalfOfTheProduct) {
    Pcg32 random(3);
    for (int i = 0; i < 10000; ++i) {
        const uint32_t a = i == 0 ? 0xFFFFFFFFU : random.next_uint();
        const uint32_t b = i < 2 ? 0xFFFFFFFFU : random.next_uint() >> (i % 32);
        EXPECT_EQ(multiply_high(a, b), static_cast<uint32_t>(uint64_t{a} * b >> 32));
    }
}

TEST(CdfTable, ProbabilitiesFollowTheWeights) {
    for (const size_t count : {1U, 2U, 3U, 7U, 64U, 1000U, 16384U}) {
        std::vector<double> weights = random_weights(count, count);
        weights[0] += 1;
        const std::vector<double> got = shares_of(table_for(weights));
        const double sum = sum_of(weights);
        EXPECT_DOUBLE_EQ(sum_of(got), 1.0);
        const double limit = static_cast<double>(count) * grain;
        for (size_t i = 0; i < count; ++i) {
            EXPECT_NEAR(got[i], weights[i] / sum, limit) << count << " entries, index " << i;
            EXPECT_EQ(got[i] > 0, weights[i] > 0) << count << " entries, index " << i;
        }
    }
}

TEST(CdfTable, AMillionEntriesKeepTheirShares) {
    const size_t count = 1 << 20;
    std::vector<double> weights(count, 1.0);
    weights[12345] = static_cast<double>(count);  // half of everything
    const std::vector<double> got = shares_of(table_for(weights));
    EXPECT_NEAR(got[12345], 0.5, 1e-6 + 0x1p-12);
    EXPECT_NEAR(sum_of(got), 1.0, 1e-9);
    for (size_t i = 0; i < count; i += 997) {
        EXPECT_NEAR(got[i] * 2 * static_cast<double>(count), 1.0, 1e-3) << i;
    }
}

TEST(CdfTable, TheFaintestEntryIsStillReached) {
    std::vector<double> weights(1000, 1.0);
    weights[500] = 1e30;
    const std::vector<double> got = shares_of(table_for(weights));
    for (size_t i = 0; i < weights.size(); ++i)
        EXPECT_GE(got[i], grain) << i;
}

/// Faint indices must not take the steps that they need from a brighter neighbour.
TEST(CdfTable, TheRimOfASunKeepsItsShare) {
    std::vector<double> weights(1000, 1.0);
    weights[500] = 1e6;
    for (const size_t rim : {498U, 499U, 501U, 502U})
        weights[rim] = 1000;
    const std::vector<double> got = shares_of(table_for(weights));
    const double sum = sum_of(weights);
    for (const size_t i : {498U, 499U, 500U, 501U, 502U})
        EXPECT_NEAR(got[i] / (weights[i] / sum), 1.0, 0.05) << i;
}

TEST(CdfTable, WeightsThatAreAllZeroMeanUniform) {
    const std::vector<double> weights(5, 0.0);
    const std::vector<CdfEntry> table = table_for(weights);
    for (const double got : shares_of(table))
        EXPECT_NEAR(got, 0.2, 1e-8 + grain);
}

TEST(CdfTable, BrokenWeightsCountAsZero) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    const std::vector<double> got = shares_of(table_for({-1, 2, nan, infinity, 6}));
    const std::vector<double> expected = {0, 0.25, 0, 0, 0.75};
    for (size_t i = 0; i < got.size(); ++i)
        EXPECT_NEAR(got[i], expected[i], 1e-8 + grain) << i;
}

TEST(CdfTable, HugeWeightsDoNotOverflow) {
    const std::vector<double> got = shares_of(table_for({1.7e308, 1.7e308, 1.7e308}));
    for (const double share : got)
        EXPECT_NEAR(share, 1.0 / 3, 1e-8 + grain);
}

TEST(CdfTable, IndicesAreDrawnByTheirShares) {
    constexpr int samples = 1000000;
    std::vector<double> weights = random_weights(100, 7);
    for (double& weight : weights)
        weight = std::sqrt(weight);  // most bins get samples
    const std::vector<CdfEntry> table = table_for(weights);
    std::vector<double> expected = shares_of(table);
    for (double& count : expected)
        count *= samples;
    std::vector<double> observed(100, 0.0);
    Pcg32 random(11);
    for (int i = 0; i < samples; ++i) {
        const int32_t index = sample_cdf<float>(table.data(), 100, random.next_uint());
        observed[static_cast<size_t>(index)] += 1;
    }
    const ChiSquareOutcome right = chi_square(observed, expected);
    EXPECT_TRUE(right.passes(0.01)) << right;
    std::swap(expected[50], expected[99]);
    const ChiSquareOutcome wrong = chi_square(observed, expected);
    EXPECT_FALSE(wrong.passes(0.01)) << wrong;
}

/// Sampler and cdf_probabilities agree to the single random number at every boundary.
TEST(CdfTable, ProbabilitiesCountEveryRandomNumber) {
    const std::vector<CdfEntry> table = table_for(random_weights(7, 5));
    const auto index_of = [&](uint32_t random) {
        return sample_cdf<float>(table.data(), 7, random);
    };
    std::vector<double> counted(7, 0.0);
    uint64_t begin = 0;
    while (begin < 0x100000000U) {  // runs of equal index, each end found by bisection
        const int32_t index = index_of(static_cast<uint32_t>(begin));
        uint64_t step = uint64_t{1} << 32;
        uint64_t last = begin;
        for (; step > 0; step /= 2) {
            const uint64_t next = last + step;
            if (next < 0x100000000U && index_of(static_cast<uint32_t>(next)) == index) last = next;
        }
        counted[static_cast<size_t>(index)] += static_cast<double>(last - begin + 1) * 0x1p-32;
        begin = last + 1;
    }
    const std::vector<double> told = shares_of(table);
    for (size_t i = 0; i < 7; ++i)
        EXPECT_DOUBLE_EQ(counted[i], told[i]) << i;
}

TEST(CdfTable, TheIndexGrowsWithTheRandomNumber) {
    std::vector<double> weights = random_weights(300, 4);
    weights.insert(weights.end(), {1e7, 0, 0});
    const std::vector<CdfEntry> table = table_for(weights);
    int32_t index = 0;
    for (uint64_t random = 0; random < 0x100000000U; random += 0xFFFFF) {
        const auto bits = static_cast<uint32_t>(random);
        const int32_t next = sample_cdf<float>(table.data(), 303, bits);
        EXPECT_GE(next, index);
        EXPECT_GT(weights[static_cast<size_t>(next)], 0);
        index = next;
    }
    EXPECT_EQ(index, 300);
}

TEST(CdfTable, ADrawTellsThePlaceAmongTheNumbersOfItsIndex) {
    const std::vector<CdfEntry> table = table_for(random_weights(50, 6));
    const std::vector<double> shares = shares_of(table);
    Pcg32 random(2);
    for (int i = 0; i < 10000; ++i) {
        const uint32_t bits = random.next_uint();
        const CdfDraw<float> draw = draw_cdf<float>(table.data(), 50, bits);
        ASSERT_EQ(draw.index, sample_cdf<float>(table.data(), 50, bits));
        const auto index = static_cast<size_t>(draw.index);
        const double from_first = bits - static_cast<double>(table[index].first_random);
        ASSERT_NEAR(draw.place, from_first / (shares[index] * 0x1p32), 1e-5);
        ASSERT_LT(draw.place, 1.0f);
    }
}

TEST(CdfTable, TheOnlyPossibleIndexHasAllNumbers) {
    const std::vector<CdfEntry> table = table_for({0, 3, 0});
    EXPECT_EQ(draw_cdf<float>(table.data(), 3, 0x80000000U).index, 1);
    EXPECT_NEAR(draw_cdf<float>(table.data(), 3, 0x80000000U).place, 0.5f, 1e-6f);
    EXPECT_LT(draw_cdf<float>(table.data(), 3, 0xFFFFFFFFU).place, 1.0f);
}

/// The numbers of an index, evenly over all numbers: a chain of choices is as exact as one.
TEST(CdfTable, SpreadNumbersCoverTheWholeRangeEvenly) {
    for (const std::vector<double>& weights :
         {std::vector<double>{1, 1}, {0, 1}, {1e9, 1}, {1, 1e9}, {3, 2, 7}, {1, 0x1p-20, 1}}) {
        const std::vector<CdfEntry> table = table_for(weights);
        for (size_t i = 0; i < weights.size(); ++i) {
            if (weights[i] == 0) continue;
            const double numbers = shares_of(table)[i] * 0x1p32;
            const CdfSpread spread = cdf_spread(std::span<const CdfEntry>(table), i);
            for (const double place : {0.0, 0.001, 0.25, 0.5, 0.9, 1.0}) {
                const auto offset = static_cast<uint32_t>(place * (numbers - 1));
                const uint32_t random = table[i].first_random + offset;
                const double expected = offset / numbers * 0x1p32;
                EXPECT_NEAR(spread_random(spread, random, 1U), expected, 4) << i << ", " << place;
            }
        }
    }
}

TEST(CdfTable, LanesEqualScalars) {
    const std::vector<CdfEntry> table = table_for(random_weights(5000, 9));
    Pcg32 random(1);
    for (int round = 0; round < 1000; ++round) {
        uint32_t bits[lane_count];
        for (uint32_t& word : bits)
            word = random.next_uint();
        const LanesU in(BatchU::load_unaligned(bits));
        const LanesI got = sample_cdf<Lanes>(table.data(), 5000, in);
        int32_t index[lane_count];
        got.v.store_unaligned(index);
        for (int i = 0; i < lane_count; ++i)
            EXPECT_EQ(index[i], sample_cdf<float>(table.data(), 5000, bits[i]));
    }
}

}  // namespace
}  // namespace obscura
