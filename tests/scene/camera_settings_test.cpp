// tests/scene/camera_settings_test.cpp - settings of a file under those of the command line.
// SPDX-License-Identifier: Apache-2.0
#include "scene/camera_setting_table.h"

#include <gtest/gtest.h>

#include <set>

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

TEST(CameraSettingTable, EverySettingHasOneEntry) {
    std::set<std::string> reports;
    std::set<std::string> keys;
    CameraSettings all;
    size_t bytes = sizeof(all.model);
    for_each_camera_setting([&](const auto& entry) {
        auto& member = all.*entry.member;
        EXPECT_FALSE(member.has_value()) << entry.info.name << ": another entry has that member";
        member.emplace();
        bytes += sizeof(member);
        const std::string place = std::string(entry.info.section) + "/" +
                                  (entry.info.key ? entry.info.key : entry.info.name);
        EXPECT_TRUE(keys.insert(place).second) << place;
        const std::string report = entry.info.report;
        EXPECT_TRUE(report.empty() || reports.insert(report).second) << report;
        EXPECT_LE(entry.info.range.low, entry.info.range.high) << entry.info.name;
    });
    EXPECT_LE(sizeof(CameraSettings) - bytes, 4 * sizeof(int)) << "a member has no entry";
}

TEST(CameraSettingTable, ModelsRefuseWhatTheyDoNotHave) {
    CameraSettings settings;
    settings.near_m = 1;
    settings.shift = {{0.5, 0}};
    EXPECT_EQ(setting_without(settings, CameraModel::fisheye), nullptr);
    ASSERT_NE(setting_without(settings, CameraModel::orthographic), nullptr);
    EXPECT_STREQ(setting_without(settings, CameraModel::orthographic)->name, "shift");
    settings.fstop = 2;
    EXPECT_STREQ(setting_without(settings, CameraModel::pinhole)->name, "fstop");
    settings.shutter_s = 0.01;
    EXPECT_EQ(setting_without(settings, CameraModel::pinhole), nullptr) << "that is an exposure";
}

}  // namespace
}  // namespace obscura
