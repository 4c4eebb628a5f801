// tests/dataset/run_length_test.cpp - masks as run lengths and as COCO's text.
// SPDX-License-Identifier: Apache-2.0
#include "dataset/run_length.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace obscura::dataset {
namespace {

/// Reads the text digit by digit, as a number in base 32 of which the last digit has a sign.
std::vector<int64_t> lengths_of(const std::string& counts) {
    std::vector<int64_t> out;
    int64_t value = 0;
    int64_t scale = 1;
    for (const char c : counts) {
        const int64_t digit = c - '0';
        const bool is_last = digit < 32;
        const int64_t low = digit % 32;
        value += scale * (is_last && low >= 16 ? low - 32 : low);
        scale *= 32;
        if (!is_last) continue;
        out.push_back(out.size() > 2 ? value + out[out.size() - 2] : value);
        value = 0;
        scale = 1;
    }
    return out;
}

TEST(RunLength, GoesDownTheColumns) {
    // 0 1 1
    // 0 1 0
    EXPECT_EQ(run_lengths(std::vector<uint32_t>{1, 2, 4}, 3, 2), (std::vector<uint32_t>{2, 3, 1}));
    // 0 1 0
    // 0 0 1
    EXPECT_EQ(run_lengths(std::vector<uint32_t>{1, 5}, 3, 2), (std::vector<uint32_t>{2, 1, 2, 1}));
}

TEST(RunLength, BeginsOutside) {
    EXPECT_EQ(run_lengths(std::vector<uint32_t>{0, 1}, 2, 1), (std::vector<uint32_t>{0, 2}));
    EXPECT_EQ(run_lengths({}, 2, 1), (std::vector<uint32_t>{2}));
}

TEST(RunLength, TextHasGroupsOfFiveBits) {
    // 2 and 3 are one group each. 16 needs two: its own lower bits, and a zero that says that it is
    // not negative. From the third length on there are differences: 1 - 3 is -2, of which the five
    // lowest bits are 30.
    EXPECT_EQ(coco_counts(std::vector<uint32_t>{2, 3}), "23");
    EXPECT_EQ(coco_counts(std::vector<uint32_t>{16}), "`0");
    EXPECT_EQ(coco_counts(std::vector<uint32_t>{2, 3, 1, 1}), "231N");
}

TEST(RunLength, TextKeepsEveryMask) {
    std::mt19937 random(5);
    for (const int one_in : {2, 3, 50, 5000}) {
        std::vector<uint32_t> inside;
        for (uint32_t pixel = 0; pixel < 300 * 200; ++pixel) {
            if (random() % static_cast<unsigned>(one_in) == 0) inside.push_back(pixel);
        }
        const std::vector<uint32_t> lengths = run_lengths(inside, 300, 200);
        const std::vector<int64_t> read = lengths_of(coco_counts(lengths));
        EXPECT_TRUE(std::equal(lengths.begin(), lengths.end(), read.begin(), read.end()));
        EXPECT_EQ(std::accumulate(read.begin(), read.end(), int64_t{0}), 300 * 200);
    }
}

}  // namespace
}  // namespace obscura::dataset
