// tests/stages/media_test.cpp - the medium stack of a path: nested dielectrics by priority.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_media.h"

#include <gtest/gtest.h>

#include "support/lane_arrays.h"
#include "support/random.h"
#include <algorithm>
#include <vector>

namespace obscura::test {
namespace {

uint32_t one(LanesU medium_stack) {
    return lane(medium_stack, 0);
}

TEST(Media, TheGreatestNumberDominates) {
    LanesU medium_stack(one_wavelength);
    medium_stack = enter_medium(medium_stack, LanesI(3));
    medium_stack = enter_medium(medium_stack, LanesI(200));
    medium_stack = enter_medium(medium_stack, LanesI(7));
    EXPECT_EQ(one(medium_stack), one_wavelength | 200U << 16 | 7U << 8 | 3U);
    EXPECT_EQ(lane(dominant_medium(medium_stack), 0), 200);
    EXPECT_EQ(one(leave_medium(medium_stack, LanesI(7))), one_wavelength | 200U << 16 | 3U << 8);
    EXPECT_EQ(one(leave_medium(medium_stack, LanesI(9))), one(medium_stack)) << "never entered";
}

TEST(Media, EnteringAndLeavingInAnyOrderComesOut) {
    Pcg32 random(1);
    for (int n = 0; n < 1000; ++n) {
        LanesU medium_stack(0U);
        std::vector<int> inside;
        for (int step = 0; step < 20; ++step) {
            if (inside.size() < 3 && random.next_uint() % 2 == 0) {
                inside.push_back(static_cast<int>(1 + random.next_uint() % 255));
                medium_stack = enter_medium(medium_stack, LanesI(inside.back()));
            } else if (!inside.empty()) {
                const size_t which = random.next_uint() % inside.size();
                medium_stack = leave_medium(medium_stack, LanesI(inside[which]));
                inside.erase(inside.begin() + static_cast<std::ptrdiff_t>(which));
            }
            const int expected =
                inside.empty() ? 0 : *std::max_element(inside.begin(), inside.end());
            ASSERT_EQ(lane(dominant_medium(medium_stack), 0), expected);
        }
    }
}

}  // namespace
}  // namespace obscura::test
