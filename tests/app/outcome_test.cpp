// tests/app/outcome_test.cpp - the last lines of a command.
// SPDX-License-Identifier: Apache-2.0
#include "app/outcome.h"

#include <gtest/gtest.h>

namespace obscura::app {
namespace {

TEST(Outcome, TheResultLineHasOneWordPerField) {
    EXPECT_EQ(result_line(65, "E-ACC-TOOLONG", "scene.glb#/accessors/12", 3),
              "RESULT code=65 id=E-ACC-TOOLONG where=scene.glb#/accessors/12 warnings=3");
    EXPECT_EQ(result_line(64, "E-USAGE", "", 0), "RESULT code=64 id=E-USAGE where=- warnings=0");
    EXPECT_EQ(result_line(66, "E", "a b\nc\x1b[31m", 0),
              "RESULT code=66 id=E where=a\\x20b\\x0ac\\x1b[31m warnings=0");
}

TEST(Outcome, AFailureSaysWhereAndWhat) {
    testing::internal::CaptureStderr();
    const Log log;
    const int code =
        report_failure(Error{ExitCode::bad_data, "E-X", "a\tb.gltf#/nodes/0", "not\ngood"}, log);
    EXPECT_EQ(code, 65);
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              "ERROR a\\x09b.gltf#/nodes/0: not\\x0agood [E-X]\n"
              "RESULT code=65 id=E-X where=a\\x09b.gltf#/nodes/0 warnings=0\n");
}

TEST(Outcome, FailuresFoundTogetherAreAllPrinted) {
    testing::internal::CaptureStderr();
    const Error second{ExitCode::bad_data, "E-Y", "b", "worse"};
    const Error sum{ExitCode::bad_data, "", "", "7 more"};
    EXPECT_EQ(
        report_failure(joined({{ExitCode::bad_resource, "E-X", "a", "bad"}, second, sum}), Log()),
        67);
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              "ERROR a: bad [E-X]\nERROR b: worse [E-Y]\nERROR 7 more\n"
              "RESULT code=67 id=E-X where=a warnings=0\n");
}

TEST(Outcome, TooManyNonfiniteSamplesEndWith76) {
    testing::internal::CaptureStderr();
    const Error error{ExitCode::too_many_nonfinite, "E-NONFINITE", "bench", "9 of 10"};
    EXPECT_EQ(report_failure(error, Log()), 76);
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              "ERROR bench: 9 of 10 [E-NONFINITE]\n"
              "RESULT code=76 id=E-NONFINITE where=bench warnings=0\n");
}

TEST(Outcome, SuccessIsSilentWhenQuiet) {
    testing::internal::CaptureStderr();
    EXPECT_EQ(report_success("a.gltf", Log(Verbosity::quiet)), 0);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    testing::internal::CaptureStderr();
    EXPECT_EQ(report_success("a.gltf", Log(Verbosity::normal)), 0);
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              "RESULT code=0 id=OK where=a.gltf warnings=0\n");
}

}  // namespace
}  // namespace obscura::app
