// tests/session/tev_packets_test.cpp - packets for tev, byte by byte as its protocol wants them.
// SPDX-License-Identifier: Apache-2.0
#include "session/tev_packets.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

Bytes bytes_of(std::initializer_list<int> values) {
    Bytes out;
    for (const int value : values)
        out.push_back(static_cast<std::byte>(value));
    return out;
}

const TevImage image{"a.exr", 300, 2, {"R", "Z.V"}};

TEST(TevPackets, CreateAnImage) {
    // clang-format off
    EXPECT_EQ(tev_create_image(image), bytes_of({30, 0, 0, 0,  4,  1,
                                                 'a', '.', 'e', 'x', 'r', 0,
                                                 44, 1, 0, 0,  2, 0, 0, 0,  2, 0, 0, 0,
                                                 'R', 0,  'Z', '.', 'V', 0}));
    // clang-format on
}

TEST(TevPackets, UpdateARectangleOfAllChannels) {
    // clang-format off
    EXPECT_EQ(tev_update_image(image, {257, 1, 2, 1}, std::vector<float>{1, -2, 0.5f, 0}),
              bytes_of({86, 0, 0, 0,  6,  0,
                        'a', '.', 'e', 'x', 'r', 0,
                        2, 0, 0, 0,  'R', 0,  'Z', '.', 'V', 0,
                        1, 1, 0, 0,  1, 0, 0, 0,  2, 0, 0, 0,  1, 0, 0, 0,
                        0, 0, 0, 0, 0, 0, 0, 0,  1, 0, 0, 0, 0, 0, 0, 0,
                        2, 0, 0, 0, 0, 0, 0, 0,  2, 0, 0, 0, 0, 0, 0, 0,
                        0, 0, 0x80, 0x3f,  0, 0, 0, 0xc0,  0, 0, 0, 0x3f,  0, 0, 0, 0}));
    // clang-format on
}

}  // namespace
}  // namespace obscura
