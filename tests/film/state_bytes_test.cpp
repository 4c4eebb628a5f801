// tests/film/state_bytes_test.cpp - pieces of a film's state, which are read by themselves.
// SPDX-License-Identifier: Apache-2.0
#include "film/state_bytes.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

TEST(StateBytes, PiecesAreReadByThemselves) {
    StateWriter first;
    first.put_number(7);
    StateWriter all;
    all.put_array(first.kept());
    all.put_array(Bytes());
    all.put_number(9);
    StateReader in(all.kept());
    StateReader piece = in.piece();
    StateReader empty = in.piece();
    EXPECT_EQ(in.number(), 9U);
    EXPECT_TRUE(in.good() && in.at_end());
    EXPECT_EQ(piece.number(), 7U);
    EXPECT_TRUE(piece.good() && piece.at_end());
    EXPECT_TRUE(empty.at_end());
    piece.number();  // of the next piece
    EXPECT_FALSE(piece.good());
}

TEST(StateBytes, APieceThatIsCutOffIsNotGood) {
    StateWriter all;
    all.put_array(Bytes(16));
    StateReader in(std::span(all.kept()).first(all.kept().size() - 1));
    EXPECT_TRUE(in.piece().at_end());
    EXPECT_FALSE(in.good());
}

}  // namespace
}  // namespace obscura
