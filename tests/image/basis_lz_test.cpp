// tests/image/basis_lz_test.cpp - codebooks and slices of BasisLZ, written symbol by symbol.
// SPDX-License-Identifier: Apache-2.0
#include "image/basis_lz.h"

#include "image/basis_lz_writer.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

namespace obscura {
namespace {

using namespace testing_images;

TEST(BasisLzCodebooks, EndpointsAreDifferencesThatWrapAround) {
    BitWriter out;
    for (const int bits : {5, 5, 5, 3})
        put_flat_table(out, bits);
    out.put(0, 1);  // not grey
    const auto endpoint = [&](uint32_t table, uint32_t red, uint32_t green, uint32_t blue) {
        put_flat(out, table, 3);
        for (const uint32_t delta : {red, green, blue})
            put_flat(out, delta, 5);
    };
    endpoint(6, 3, 0, 20);  // from table 0 and (16, 16, 16)
    endpoint(3, 31, 1, 0);
    const auto endpoints = read_endpoints(out.bytes(), 2);
    ASSERT_TRUE(endpoints);
    const auto expect = [](const Etc1sEndpoint& got, int table, int red, int green, int blue) {
        EXPECT_EQ(got.table, table);
        EXPECT_EQ(got.red, red);
        EXPECT_EQ(got.green, green);
        EXPECT_EQ(got.blue, blue);
    };
    expect((*endpoints)[0], 6, 19, 16, 4);
    expect((*endpoints)[1], 1, 18, 17, 4);
    EXPECT_FALSE(read_endpoints(out.bytes(), 4));
}

/// Bright, middling and dark colours each have a code of their own: here with one word only.
TEST(BasisLzCodebooks, TheCodeDependsOnTheColourBefore) {
    BitWriter out;
    const auto only = [&](size_t symbol) {
        std::vector<int> lengths(symbol + 1, 0);
        lengths[symbol] = 1;
        put_code_lengths(out, lengths);
    };
    only(10);  // below 10: plus 10
    only(8);   // below 22: plus 8
    only(11);  // else: plus 11
    only(1);
    out.put(1, 1);  // grey
    out.put(0, 8);  // every word is 0
    const auto endpoints = read_endpoints(out.bytes(), 4);
    ASSERT_TRUE(endpoints);
    const int expected[] = {24, 3, 13, 21};
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_EQ((*endpoints)[i].red, expected[i]);
        EXPECT_EQ((*endpoints)[i].green, expected[i]);
        EXPECT_EQ((*endpoints)[i].blue, expected[i]);
        EXPECT_EQ((*endpoints)[i].table, i + 1);
    }
}

TEST(BasisLzCodebooks, SelectorsAreRawOrChangesOfTheOnesBefore) {
    BitWriter raw;
    raw.put(4, 3);
    raw.put(0x12345678U, 32);
    raw.put(0x9ABCDEF0U, 32);
    EXPECT_EQ(read_selectors(raw.bytes(), 2).value(),
              (std::vector<Etc1sSelectors>{0x12345678U, 0x9ABCDEF0U}));
    EXPECT_FALSE(read_selectors(raw.bytes(), 3));

    BitWriter changes;
    changes.put(0, 3);
    put_flat_table(changes, 8);
    changes.put(0x12345678U, 32);
    for (const uint32_t change : {0x01U, 0x00U, 0xFFU, 0x10U})
        put_flat(changes, change, 8);
    EXPECT_EQ(read_selectors(changes.bytes(), 2).value(),
              (std::vector<Etc1sSelectors>{0x12345678U, 0x02CB5679U}));

    BitWriter reserved;
    reserved.put(5, 3);
    reserved.put(0, 32);
    EXPECT_FALSE(read_selectors(reserved.bytes(), 1));
}

/// Four endpoints, three selectors, a history of four.
class BasisLzSlice : public testing::Test {
protected:
    static constexpr uint32_t history = 3;  ///< symbol of the first selector in the history
    static constexpr uint32_t run = 7;      ///< symbol of a run

    void SetUp() override {
        books_.endpoints.resize(4);
        books_.selectors.resize(3);
        BitWriter tables;
        for (const int bits : {9, 2, 3, 6})
            put_flat_table(tables, bits);
        tables.put(4, 13);
        const auto codes = read_slice_codes(tables.bytes());
        ASSERT_TRUE(codes);
        codes_ = *codes;
        EXPECT_FALSE(read_slice_codes(std::span(tables.bytes()).first(tables.bytes().size() / 2)));
    }

    void predictions(uint32_t of_four) { put_flat(out_, of_four, 9); }
    void selectors(std::initializer_list<uint32_t> symbols) {
        for (const uint32_t symbol : symbols)
            put_flat(out_, symbol, 3);
    }
    void coded(uint32_t delta, uint32_t symbol) {
        put_flat(out_, delta, 2);
        selectors({symbol});
    }
    void selector_run(uint32_t length) {
        selectors({run});
        put_flat(out_, length, 6);
    }

    /// "endpoint/selector" of each block, or "" where the slice is broken.
    std::string read(size_t columns, size_t rows) const {
        const auto blocks = read_slice(out_.bytes(), books_, codes_, columns, rows);
        std::string text;
        for (const BasisLzBlock& block : blocks.value_or(std::vector<BasisLzBlock>()))
            text += std::to_string(block.endpoint) + "/" + std::to_string(block.selector) + " ";
        return text;
    }

    BasisLzCodebooks books_;
    BasisLzCodes codes_;
    BitWriter out_;
};

TEST_F(BasisLzSlice, EndpointsComeFromNeighboursOrDifferences) {
    predictions(0b10'01'00'11);  // delta, left; above, above left
    coded(3, 0);
    selectors({1});
    predictions(0b01'01'11'11);
    coded(2, 2);  // 3 + 2 wraps to 1
    coded(1, 0);
    selectors({1, 2, 0, 1});
    EXPECT_EQ(read(4, 2), "3/0 3/1 1/2 2/0 3/1 3/2 1/0 2/1 ");
}

TEST_F(BasisLzSlice, PredictionsRepeat) {
    predictions(0b11'11'11'11);
    coded(1, 0);
    coded(1, 0);
    predictions(256);
    put_chunked(out_, 17, 4);  // 20 times
    std::string expected = "1/0 2/0 ";
    for (int i = 2; i < 42; ++i) {
        coded(1, 1);
        expected += std::to_string((i + 1) % 4) + "/1 ";
    }
    EXPECT_EQ(read(42, 1), expected);
}

TEST_F(BasisLzSlice, SelectorsComeFromTheHistoryAndInRuns) {
    predictions(0b00'00'00'11);
    coded(0, 1);               // the history is 0 0 1 0
    selectors({history + 2});  // 0 1 0 0
    predictions(0);
    selectors({history + 1, history});  // 1 0 0 0
    predictions(0);
    selector_run(2);  // five times the front
    predictions(0);
    predictions(0);
    selectors({2});  // 1 0 0 2
    predictions(0);
    selectors({history + 3, history + 1});  // 1 2 0 0, 2 1 0 0
    EXPECT_EQ(read(12, 1), "0/1 0/1 0/1 0/1 0/1 0/1 0/1 0/1 0/1 0/2 0/2 0/2 ");
}

TEST_F(BasisLzSlice, LongRunsOfSelectorsHaveALengthOfTheirOwn) {
    predictions(0b00'00'00'11);
    put_flat(out_, 0, 2);
    selector_run(63);
    put_chunked(out_, 200, 7);  // 203 blocks
    predictions(0);
    predictions(256);
    put_chunked(out_, 98, 4);  // 101 pairs
    selectors({2, 2, 2});
    std::string expected;
    for (int i = 0; i < 206; ++i)
        expected += i < 203 ? "0/0 " : "0/2 ";
    EXPECT_EQ(read(206, 1), expected);
}

TEST_F(BasisLzSlice, NeighboursThatAreNotThereAreRefused) {
    predictions(0b00'00'00'00);
    selectors({0, 0, 0, 0});
    EXPECT_EQ(read(2, 2), "");
}

TEST_F(BasisLzSlice, NumbersBeyondTheTablesAreRefused) {
    predictions(257);
    EXPECT_EQ(read(1, 1), "");
}

TEST_F(BasisLzSlice, UnboundedNumbersAreRefused) {
    predictions(256);
    for (int i = 0; i < 20; ++i)
        out_.put(0xFFFFFFFFU, 32);
    EXPECT_EQ(read(2, 2), "");
}

TEST_F(BasisLzSlice, ACutOffSliceIsRefused) {
    predictions(0b11'11'11'11);
    coded(0, 0);
    EXPECT_EQ(read(1, 1), "0/0 ");
    EXPECT_EQ(read(40, 40), "");
}

TEST_F(BasisLzSlice, EmptyCodebooksAreRefused) {
    predictions(0b11'11'11'11);
    coded(0, 0);
    books_.selectors.clear();
    EXPECT_EQ(read(1, 1), "");
}

}  // namespace
}  // namespace obscura
