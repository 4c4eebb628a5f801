// tests/base/log_test.cpp - messages, their sink, and the names of settings in them.
// SPDX-License-Identifier: Apache-2.0
#include "base/log.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

TEST(Log, WithoutASinkNothingIsPrintedAndWarningsAreKept) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    Log log(Verbosity::verbose);
    log.warn("a.gltf#/nodes/1", "odd\x1b");
    log.info("note");
    EXPECT_EQ(testing::internal::GetCapturedStdout() + testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(log.warnings(), std::vector<std::string>{"a.gltf#/nodes/1: odd\\x1b"});
}

TEST(Log, TheSinkGetsWhatTheVerbosityLetsThrough) {
    std::string seen;
    const LogSink sink = [&](const LogMessage& message) {
        seen += message.is_warning ? "w" : "i";
        seen += std::string(message.where) + "," + std::string(message.text) + ";";
    };
    for (const auto& [verbosity, expected] : {std::pair{Verbosity::quiet, ""},
                                              std::pair{Verbosity::normal, "wa,b;i,c;"},
                                              std::pair{Verbosity::verbose, "wa,b;i,c;i,d;"}}) {
        seen.clear();
        Log log(verbosity, sink);
        log.warn("a", "b");
        log.info("c");
        log.detail("d");
        EXPECT_EQ(seen, expected);
        EXPECT_EQ(log.warnings().size(), 1U);
    }
}

TEST(SettingNames, AreSpelledForWhoReadsThem) {
    const std::string text = "give " + setting("focus-distance") + ", or " + setting("fstop") + ".";
    EXPECT_EQ(spell_settings(text, SettingNames::plain), "give focus_distance, or fstop.");
    EXPECT_EQ(spell_settings(text, SettingNames::options), "give --focus-distance, or --fstop.");
    EXPECT_EQ(spell_settings(text, SettingNames::fields), "give focus_distance_m, or fstop.");
    const std::string time = setting("exposure-time");
    EXPECT_EQ(spell_settings(time, SettingNames::options), "--shutter");
    EXPECT_EQ(spell_settings(time, SettingNames::plain), "shutter");
    EXPECT_EQ(spell_settings(time, SettingNames::fields), "exposure_s");
    EXPECT_EQ(spell_settings("a-b --c", SettingNames::plain), "a-b --c");
    Log log(Verbosity::quiet, {}, SettingNames::options);
    log.warn(setting("env"), "x");
    EXPECT_EQ(log.warnings().front(), "--env: x");
}

}  // namespace
}  // namespace obscura
