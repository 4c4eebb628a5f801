// tests/base/checksum_test.cpp - XXH64 against published values.
// SPDX-License-Identifier: Apache-2.0
#include "base/checksum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>

namespace obscura {
namespace {

uint64_t checksum_of(std::string_view text) {
    return checksum(std::as_bytes(std::span(text)));
}

/// From the tests of other implementations: Python's xxhash and Go's cespare/xxhash.
TEST(Checksum, GivesThePublishedValues) {
    EXPECT_EQ(checksum_of(""), 0xef46db3751d8e999U);
    EXPECT_EQ(checksum_of("a"), 0xd24ec4f1a98c6e5bU);
    EXPECT_EQ(checksum_of("as"), 0x1c330fb2d66be179U);
    EXPECT_EQ(checksum_of("asd"), 0x631c37ce72a97393U);
    EXPECT_EQ(checksum_of("asdf"), 0x415872f599cea71eU);
    EXPECT_EQ(checksum_of("Call me Ishmael. Some years ago--never mind how long precisely-"),
              0x02a2e85470d6fd96U);
}

TEST(Checksum, AsTextHasAllItsDigits) {
    EXPECT_EQ(checksum_text(0), "0000000000000000");
    EXPECT_EQ(checksum_text(0x02a2e85470d6fd96U), "02a2e85470d6fd96");
}

TEST(Checksum, OfPiecesIsThatOfTheWhole) {
    std::string text;
    for (int i = 0; i < 150; ++i)
        text += static_cast<char>(i * 37);
    for (size_t size = 1; size < 70; ++size) {
        RunningChecksum sum;
        for (size_t at = 0; at < text.size(); at += size)
            sum.add(std::as_bytes(std::span(text)).subspan(at, std::min(size, text.size() - at)));
        EXPECT_EQ(sum.value(), checksum_of(text)) << size;
    }
}

}  // namespace
}  // namespace obscura
