// tests/scene/camera_settings_test.cpp - settings of a file under those of the command line.
// SPDX-License-Identifier: Apache-2.0
#include "scene/camera_settings.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

TEST(CameraSettings, WhatIsSaidLaterCountsOneByOne) {
    CameraSettings file;
    file.fstop = 2;
    file.focus_distance_m = 3;
    file.near_m = 1;
    CameraSettings options;
    options.focus_distance_m = 4;
    const CameraSettings both = merge_settings(file, options);
    EXPECT_EQ(both.fstop, 2);
    EXPECT_EQ(both.focus_distance_m, 4);
    EXPECT_EQ(both.near_m, 1);
}

TEST(CameraSettings, OneOpeningReplacesTheOtherAndSoDoExposures) {
    CameraSettings file;
    file.fstop = 2;
    file.ev100 = 10;
    CameraSettings options;
    options.lens_radius_m = 0.1;
    options.iso = 400;
    const CameraSettings both = merge_settings(file, options);
    EXPECT_EQ(both.fstop, std::nullopt);
    EXPECT_EQ(both.lens_radius_m, 0.1);
    EXPECT_EQ(both.ev100, std::nullopt);
}

TEST(CameraSettings, TextsSayWhatIsThere) {
    CameraSettings s;
    EXPECT_TRUE(settings_texts(s).empty());
    s.fisheye = FisheyeLaw::equisolid;
    s.distortion = {{0.5, 0, 0, 0, -1}};
    const auto texts = settings_texts(s);
    ASSERT_EQ(texts.size(), 2U);
    EXPECT_EQ(texts[0].second, "0.5,0,0,0,-1");
    EXPECT_EQ(texts[1].second, "equisolid");
}

}  // namespace
}  // namespace obscura
