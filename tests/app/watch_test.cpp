// tests/app/watch_test.cpp - when checkpoints are due, and what ends a command at once.
// SPDX-License-Identifier: Apache-2.0
#include "app/watch.h"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <thread>

namespace obscura::app {
namespace {

TEST(Repetition, IsDueAfterTheFirstTimeThenAfterTheInterval) {
    Repetition saves(30, 300, 0.02);
    saves.begin(100);
    EXPECT_FALSE(saves.is_due(129));
    EXPECT_TRUE(saves.is_due(130));
    saves.done(130, 131);
    EXPECT_FALSE(saves.is_due(430));
    EXPECT_TRUE(saves.is_due(431));
}

TEST(Repetition, TakesAtMostItsShareOfTheTime) {
    Repetition saves(1, 1, 0.02);
    saves.begin(0);
    saves.done(1, 3);  // 2 s are 0.02 of 100 s
    EXPECT_FALSE(saves.is_due(100));
    EXPECT_TRUE(saves.is_due(101));
}

TEST(Repetition, TheFirstCheckpointIsEarly) {
    EXPECT_EQ(first_checkpoint_s(300), 30);
    EXPECT_EQ(first_checkpoint_s(5), 5);
}

TEST(Watch, EndsNothingAtOnceWhileFilesAreWrittenBeside) {
    const auto write_beside = [] {
        Log log;
        Watch watch("scene", log, {0.001, {}, {}});
        watch.begin_writing_beside();
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        std::fputs("written\n", stderr);
        watch.end_writing_beside();
        std::this_thread::sleep_for(std::chrono::minutes(1));
    };
    EXPECT_EXIT(write_beside(), testing::ExitedWithCode(75), "written\n(.|\n)*E-TIME-LIMIT");
}

TEST(Watch, ASignalBetweenTwoRenderingsIsNotLost) {
    const auto render_two = [] {
        Log log;
        const StopOnSignal command(StopOnSignal::Kind::farm_too);
        { const Watch first("scene", log, {}); }
        std::raise(SIGUSR1);
        std::fputs("between\n", stderr);
        const Watch second("scene", log, {});
        std::fputs("goes on\n", stderr);
    };
    EXPECT_EXIT(render_two(), testing::ExitedWithCode(75), "^between\n(.|\n)*SIGUSR1");
}

/// What a time limit has stopped does not stop the next rendering.
TEST(StopOnSignal, OnesThatFollowAreClearOfATimeLimit) {
    const StopOnSignal command;
    {
        StopOnSignal first;
        first.stop();
        EXPECT_TRUE(command.flag());
    }
    const StopOnSignal second;
    EXPECT_FALSE(second.flag());
}

TEST(Watch, ASignalEndsTheReadingOfACheckpointAtOnceTheTimeLimitDoesNot) {
    const auto read = [] {
        Log log;
        Watch watch("scene", log, {0.001, {}, {}});
        watch.begin_reading();
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        std::fputs("reading\n", stderr);
        std::raise(SIGUSR1);
        std::this_thread::sleep_for(std::chrono::minutes(1));
    };
    EXPECT_EXIT(read(), testing::ExitedWithCode(75), "reading\n(.|\n)*E-STOPPED");
}

}  // namespace
}  // namespace obscura::app
