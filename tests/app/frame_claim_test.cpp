// tests/app/frame_claim_test.cpp - how images are named that are left to others.
// SPDX-License-Identifier: Apache-2.0
#include "app/frame_claim.h"

#include <gtest/gtest.h>

namespace obscura::app {
namespace {

TEST(FrameClaims, NameFramesByRanges) {
    EXPECT_EQ(ranges_text({}), "");
    EXPECT_EQ(ranges_text({3}), "3");
    EXPECT_EQ(ranges_text({3, 7, 8, 9, 12}), "3, 7-9, 12");
    EXPECT_EQ(ranges_text({9, 8}), "9, 8");
}

TEST(FrameClaims, WhatIsLeftIsAnError) {
    RenderRequest request;
    request.scene = "a.gltf";
    EXPECT_TRUE(check_none_left({}, request));
    const auto several = check_none_left({{3, 0, {}}, {4, 0, {}}}, request);
    ASSERT_FALSE(several);
    EXPECT_EQ(several.error().code, ExitCode::stopped_early);
    EXPECT_EQ(several.error().id, "E-LOCKED");
    EXPECT_EQ(several.error().message.find("frames 3-4 are left to others"), 0U);
    const auto one = check_none_left({{{}, 0, {"a.exr"}}}, request);
    EXPECT_EQ(one.error().message.find("a.exr is left to others"), 0U);
}

}  // namespace
}  // namespace obscura::app
