// tests/serve/program_output_test.cpp - messages of `obscura batch` become errors again.
// SPDX-License-Identifier: Apache-2.0
#include "serve/program_output.h"

#include <gtest/gtest.h>

#include "support/temp_folder.h"

namespace obscura::serve {
namespace {

TEST(ProgramOutput, SuccessHasCounts) {
    const ProgramOutput got = parse_program_output(
        "INFO 3 images\nWARN a.glb: odd\nINFO 4 images\nRESULT code=0 id=OK where=x warnings=1\n");
    EXPECT_FALSE(got.error);
    EXPECT_EQ(got.images, 7);
    EXPECT_EQ(got.warnings, 1);
}

TEST(ProgramOutput, FailuresHaveIdPlaceAndText) {
    const ProgramOutput got = parse_program_output(
        "ERROR my job#/a: b: it is so [E-A]\n"
        "ERROR other: no [E-B]\n"
        "RESULT code=65 id=E-A where=my\\x20job#/a:\\x20b warnings=0\n");
    ASSERT_TRUE(got.error);
    EXPECT_EQ(got.error->code, ExitCode::bad_data);
    EXPECT_EQ(got.error->id, "E-A");
    EXPECT_EQ(got.error->where, "my job#/a: b");
    EXPECT_EQ(got.error->message, "it is so");
    ASSERT_EQ(got.error->also.size(), 1U);
    EXPECT_EQ(got.error->also[0].id, "E-B");
    EXPECT_EQ(got.error->also[0].where, "other");
    EXPECT_EQ(got.error->also[0].message, "no");
}

TEST(ProgramOutput, SilenceIsNoSuccess) {
    EXPECT_FALSE(parse_program_output("").error);
    EXPECT_EQ(error_of_code(137).id, "E-INTERNAL");
    EXPECT_NE(error_of_code(137).message.find("signal 9"), std::string::npos);
    EXPECT_NE(error_of_code(3).message.find("code 3"), std::string::npos);
}

TEST(ProgramOutput, AFilesEndBeginsWithALine) {
    const TempFolder folder;
    const auto file = folder.write("log", "one\ntwo\nthree\n");
    EXPECT_EQ(end_of_file(file, 100), "one\ntwo\nthree\n");
    EXPECT_EQ(end_of_file(file, 8), "three\n");
    EXPECT_EQ(end_of_file(folder / "none", 8), "");
}

}  // namespace
}  // namespace obscura::serve
