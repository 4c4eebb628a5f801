// tests/math/table_row_test.cpp - a shared row and rows of each lane's own read the same words.
// SPDX-License-Identifier: Apache-2.0
#include "math/table_row.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace obscura {
namespace {

constexpr int words = 5;

std::vector<int32_t> table_of(int rows) {
    std::vector<int32_t> table;
    for (int i = 0; i < rows * words; ++i)
        table.push_back(float_bits(100.0F + static_cast<float>(i)));
    return table;
}

/// Reads all words of the given rows, one row a lane, and compares with the table.
void expect_rows(const int32_t (&rows)[16], bool shared) {
    const std::vector<int32_t> table = table_of(20);
    const TableRow<Lanes> row(table.data(), load(rows), words);
    EXPECT_EQ(row.shared(), shared);
    for (int word = 0; word < words; ++word) {
        float numbers[16];
        int32_t integers[16];
        int32_t varying[16];
        store(numbers, row.number(word));
        store(integers, row.integer(word));
        store(varying, row.varying_integer(LanesI(word)));
        for (int lane = 0; lane < lane_count; ++lane) {
            const int32_t expected = table[static_cast<size_t>(rows[lane] * words + word)];
            EXPECT_EQ(integers[lane], expected);
            EXPECT_EQ(varying[lane], expected);
            EXPECT_EQ(numbers[lane], bits_float(expected));
        }
    }
}

TEST(TableRow, LanesThatShareARow) {
    int32_t rows[16];
    for (const int32_t row : {0, 7, 19}) {
        std::fill_n(rows, 16, row);
        expect_rows(rows, true);
    }
}

TEST(TableRow, OneLaneThatDiffersIsEnough) {
    for (int lane = 0; lane < lane_count; ++lane) {
        int32_t rows[16];
        std::fill_n(rows, 16, 3);
        rows[lane] = 11;
        expect_rows(rows, false);
    }
}

TEST(TableRow, OneWordOfASharedRowAndScalars) {
    const std::vector<int32_t> table = table_of(4);
    const TableRow<Lanes> lanes(table.data(), LanesI(2), words);
    EXPECT_EQ(lanes.one_integer(3), table[13]);
    const TableRow<double> scalar(table.data(), 2, words);
    EXPECT_TRUE(scalar.shared());
    EXPECT_EQ(scalar.number(4), 114.0);
}

}  // namespace
}  // namespace obscura
