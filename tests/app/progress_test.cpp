// tests/app/progress_test.cpp - when progress is reported, and how the bar looks.
// SPDX-License-Identifier: Apache-2.0
#include "app/progress.h"

#include <gtest/gtest.h>

#include <gmock/gmock.h>

namespace obscura::app {
namespace {

TEST(ProgressPacer, TellsAtOnceThenAtMostOnceASecond) {
    ProgressPacer pacer;
    EXPECT_EQ(pacer.due(0.0, 0.0), 0);
    EXPECT_EQ(pacer.due(0.5, 0.2), std::nullopt);
    EXPECT_EQ(pacer.due(1.0, 0.3), 30);
    EXPECT_EQ(pacer.due(1.9, 0.9), std::nullopt);
    EXPECT_EQ(pacer.due(2.0, 0.9), 90);
}

TEST(ProgressPacer, RepeatsItselfAfterThirtySeconds) {
    ProgressPacer pacer;
    EXPECT_EQ(pacer.due(0.0, 0.101), 10);
    EXPECT_EQ(pacer.due(29.9, 0.109), std::nullopt);
    EXPECT_EQ(pacer.due(30.0, 0.109), 10);
    EXPECT_EQ(pacer.due(59.0, 0.109), std::nullopt);
    EXPECT_EQ(pacer.due(60.0, 0.109), 10);
}

TEST(ProgressPacer, NeverGoesBackAndKeepsTheHundredForTheEnd) {
    ProgressPacer pacer;
    EXPECT_EQ(pacer.due(0, 0.5), 50);
    EXPECT_EQ(pacer.due(31, 0.4), 50);
    EXPECT_EQ(pacer.due(40, 1.0), 99);
}

TEST(ProgressBar, ShowsShareAndTimeLeft) {
    EXPECT_EQ(progress_bar(0.5, 60, 40), " 50% [###########...........] 1:00 left");
    EXPECT_EQ(progress_bar(0.0, 60, 40), "  0% [.....................] estimating");
    EXPECT_THAT(progress_bar(0.1, 3600, 80), testing::HasSubstr("9:00:00 left"));
    EXPECT_THAT(progress_bar(1.0, 3600, 80), testing::HasSubstr("0:00 left"));
}

TEST(ProgressBar, FitsEveryTerminal) {
    for (int columns = 1; columns < 200; ++columns) {
        EXPECT_LE(progress_bar(0.37, 100, columns).size(), static_cast<size_t>(columns));
    }
}

TEST(Progress, QuietPrintsNothing) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    {
        Progress progress(Verbosity::quiet);
        progress.begin();
        progress.update(0.5);
        progress.finish();
    }
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Progress, LinesStartAtZeroAndEndAtHundred) {
    testing::internal::CaptureStderr();  // not a terminal, whatever runs the test
    testing::internal::CaptureStdout();
    {
        Progress progress(Verbosity::normal);
        progress.begin();
        progress.update(0.5);
        progress.finish();
    }
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "Progress: 0%\nProgress: 100%\n");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

/// An image on standard output stays alone there.
TEST(Progress, LinesGoWhereTheyAreSent) {
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout();
    {
        Progress progress(Verbosity::normal, stderr);
        progress.begin();
        progress.finish();
    }
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "Progress: 0%\nProgress: 100%\n");
}

TEST(Progress, AFarmManagerHasALineOfItsOwn) {
    EXPECT_EQ(progress_lines(FarmManager::none, 42), "Progress: 42%\n");
    EXPECT_EQ(progress_lines(FarmManager::deadline, 42), "Progress: 42%\n");
    EXPECT_EQ(progress_lines(FarmManager::alfred, 42), "Progress: 42%\nALF_PROGRESS 42%\n");
    EXPECT_EQ(progress_lines(FarmManager::openjd, 42), "Progress: 42%\nopenjd_progress: 42\n");
}

TEST(Progress, AFarmManagerIsToldWhenQuiet) {
    testing::internal::CaptureStdout();
    {
        Progress progress(Verbosity::quiet, stdout, FarmManager::alfred);
        progress.begin();
        progress.finish();
    }
    EXPECT_EQ(testing::internal::GetCapturedStdout(),
              "Progress: 0%\nALF_PROGRESS 0%\nProgress: 100%\nALF_PROGRESS 100%\n");
}

TEST(Progress, AFailureHasNoLastLine) {
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout();
    { Progress progress(Verbosity::normal); }
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "Progress: 0%\n");
    testing::internal::GetCapturedStderr();
}

}  // namespace
}  // namespace obscura::app
