// tests/stages/media_test.cpp - the stack of bodies that a path travels in.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_media.h"

#include <gtest/gtest.h>

#include "support/lane_rows.h"
#include "support/random.h"
#include <algorithm>
#include <vector>

namespace obscura::test {
namespace {

uint32_t one(LanesU bodies) {
    return lane(bodies, 0);
}

TEST(Media, TheGreatestNumberFillsThePlace) {
    LanesU bodies(one_wavelength);
    bodies = enter_body(bodies, LanesI(3));
    bodies = enter_body(bodies, LanesI(200));
    bodies = enter_body(bodies, LanesI(7));
    EXPECT_EQ(one(bodies), one_wavelength | 200U << 16 | 7U << 8 | 3U);
    EXPECT_EQ(lane(filling_body(bodies), 0), 200);
    EXPECT_EQ(one(leave_body(bodies, LanesI(7))), one_wavelength | 200U << 16 | 3U << 8);
    EXPECT_EQ(one(leave_body(bodies, LanesI(9))), one(bodies)) << "never entered";
}

TEST(Media, EnteringAndLeavingInAnyOrderComesOut) {
    Pcg32 random(1);
    for (int n = 0; n < 1000; ++n) {
        LanesU bodies(0U);
        std::vector<int> inside;
        for (int step = 0; step < 20; ++step) {
            if (inside.size() < 3 && random.next_uint() % 2 == 0) {
                inside.push_back(static_cast<int>(1 + random.next_uint() % 255));
                bodies = enter_body(bodies, LanesI(inside.back()));
            } else if (!inside.empty()) {
                const size_t which = random.next_uint() % inside.size();
                bodies = leave_body(bodies, LanesI(inside[which]));
                inside.erase(inside.begin() + static_cast<std::ptrdiff_t>(which));
            }
            const int expected =
                inside.empty() ? 0 : *std::max_element(inside.begin(), inside.end());
            ASSERT_EQ(lane(filling_body(bodies), 0), expected);
        }
    }
}

}  // namespace
}  // namespace obscura::test
