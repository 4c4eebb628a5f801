// tests/image/huffman_test.cpp - canonical codes: RFC 1951's example, runs of lengths, broken ones.
// SPDX-License-Identifier: Apache-2.0
#include "image/huffman.h"

#include "image/basis_lz_writer.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace obscura {
namespace {

using namespace testing_images;

constexpr uint8_t rfc_lengths[] = {3, 3, 3, 3, 3, 2, 4, 4};  // of A to H

void put_rfc_example(BitWriter& out) {
    for (const char* code : {"010", "011", "100", "101", "110", "00", "1110", "1111"})
        out.put_code(code);
}

TEST(BitReader, TakesTheLowestBitsFirstAndKnowsTheEnd) {
    constexpr std::byte bytes[] = {std::byte{0xB5}, std::byte{0x01}};
    BitReader bits(bytes);
    EXPECT_EQ(bits.read(3), 5U);
    EXPECT_EQ(bits.peek(9), 0x36U);
    EXPECT_EQ(bits.read(13), 0x36U);
    EXPECT_FALSE(bits.overran());
    EXPECT_EQ(bits.peek(32), 0U);
    EXPECT_FALSE(bits.overran());
    EXPECT_EQ(bits.read(1), 0U);
    EXPECT_TRUE(bits.overran());
}

TEST(Huffman, CodesAreThoseOfRfc1951) {
    HuffmanTable table;
    ASSERT_TRUE(table.build(rfc_lengths));
    BitWriter out;
    put_rfc_example(out);
    BitReader bits(out.bytes());
    for (int symbol = 0; symbol < 8; ++symbol)
        EXPECT_EQ(table.decode(bits), symbol);
}

TEST(Huffman, OneSymbolIsEnoughAndGapsAreNot) {
    HuffmanTable table;
    constexpr uint8_t one[] = {0, 0, 1};
    ASSERT_TRUE(table.build(one));
    constexpr std::byte zero_then_one[] = {std::byte{2}};
    BitReader bits(zero_then_one);
    EXPECT_EQ(table.decode(bits), 2);
    EXPECT_EQ(table.decode(bits), -1);
    constexpr uint8_t gap[] = {2, 2, 2};
    EXPECT_FALSE(table.build(gap));
    constexpr uint8_t overlap[] = {1, 1, 1};
    EXPECT_FALSE(table.build(overlap));
    constexpr uint8_t too_long[] = {17, 1};
    EXPECT_FALSE(table.build(too_long));
    ASSERT_TRUE(table.build({}));
    EXPECT_EQ(table.decode(bits), -1);
}

TEST(Huffman, StoredLengthsComeBack) {
    BitWriter out;
    put_code_lengths(out, {3, 3, 3, 3, 3, 2, 4, 4});
    put_rfc_example(out);
    BitReader bits(out.bytes());
    const auto table = read_huffman_table(bits);
    ASSERT_TRUE(table);
    for (int symbol = 0; symbol < 8; ++symbol)
        EXPECT_EQ(table->decode(bits), symbol);
    EXPECT_FALSE(bits.overran());
}

/// One step of a list of code lengths: a length of 1 to 4 or a run (17 to 20), with the bits that
/// follow it.
struct Token {
    uint32_t symbol;
    uint32_t extra;
    int extra_bits;
};

std::vector<std::byte> table_of(size_t symbols, const std::vector<Token>& tokens) {
    BitWriter out;
    out.put(symbols, 14);
    out.put(21, 5);
    constexpr uint32_t used[] = {1, 2, 3, 4, 17, 18, 19, 20};  // codes of three bits, in this order
    for (const uint32_t symbol : {17U, 18U, 19U, 20U, 0U,  8U, 7U,  9U, 6U,  10U, 5U,
                                  11U, 4U,  12U, 3U,  13U, 2U, 14U, 1U, 15U, 16U}) {
        const bool is_used = std::find(std::begin(used), std::end(used), symbol) != std::end(used);
        out.put(is_used ? 3 : 0, 3);
    }
    for (const Token& token : tokens) {
        const auto* at = std::find(std::begin(used), std::end(used), token.symbol);
        put_flat(out, static_cast<uint32_t>(at - used), 3);
        out.put(token.extra, token.extra_bits);
    }
    return out.bytes();
}

TEST(Huffman, RunsOfLengthsRepeatZerosOrTheLastOne) {
    // 4 zeros, 13 zeros, then 1 + 6 + 9 symbols of 4 bits.
    const auto bytes = table_of(33, {{17, 1, 3}, {18, 2, 7}, {4, 0, 0}, {19, 3, 2}, {20, 2, 7}});
    BitReader bits(bytes);
    const auto table = read_huffman_table(bits);
    ASSERT_TRUE(table);
    BitWriter out;
    for (uint32_t i = 0; i < 16; ++i)
        put_flat(out, i, 4);
    BitReader symbols(out.bytes());
    for (int i = 0; i < 16; ++i)
        EXPECT_EQ(table->decode(symbols), 17 + i);
}

TEST(Huffman, BrokenTablesAreRefused) {
    const auto reads = [](const std::vector<std::byte>& bytes) {
        BitReader bits(bytes);
        return read_huffman_table(bits).has_value();
    };
    EXPECT_TRUE(reads(table_of(4, {{2, 0, 0}, {19, 0, 2}})));
    EXPECT_FALSE(reads(table_of(4, {{19, 0, 2}, {2, 0, 0}})));    // repeats nothing
    EXPECT_FALSE(reads(table_of(10, {{17, 0, 3}, {20, 0, 7}})));  // repeats a zero
    EXPECT_FALSE(reads(table_of(4, {{2, 0, 0}, {19, 1, 2}})));    // a run too long
    EXPECT_FALSE(reads(table_of(40, {{2, 0, 0}, {19, 0, 2}})));   // cut off
    EXPECT_FALSE(reads(table_of(4, {{1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}})));
    BitWriter no_length_codes;
    no_length_codes.put(4, 14);
    no_length_codes.put(0, 5);
    EXPECT_FALSE(reads(no_length_codes.bytes()));
    BitWriter too_many;
    too_many.put(4, 14);
    too_many.put(22, 5);
    EXPECT_FALSE(reads(too_many.bytes()));
}

}  // namespace
}  // namespace obscura
