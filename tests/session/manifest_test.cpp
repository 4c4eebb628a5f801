// tests/session/manifest_test.cpp - the file of --manifest: its folder, lines that were cut off.
// SPDX-License-Identifier: Apache-2.0
#include "session/manifest.h"

#include <gtest/gtest.h>

#include "support/temp_folder.h"
#include <sys/stat.h>

namespace obscura {
namespace {

void add_line(const std::filesystem::path& file, bool anew, const std::string& line) {
    Result<Manifest> manifest = Manifest::open(file, anew);
    ASSERT_TRUE(manifest) << manifest.error().message;
    ASSERT_TRUE(manifest->add(line));
}

TEST(Manifest, MakesItsFolderAndKeepsLines) {
    const TempFolder folder;
    const std::filesystem::path file = folder / "new/deep/m.jsonl";
    add_line(file, true, "1");
    add_line(file, false, "2");
    EXPECT_EQ(read_whole_file(folder / "new/deep/m.jsonl"), "1\n2\n");
    add_line(file, true, "3");
    EXPECT_EQ(read_whole_file(folder / "new/deep/m.jsonl"), "3\n");
}

TEST(Manifest, ALineThatWasCutOffStaysAlone) {
    const TempFolder folder;
    const std::filesystem::path file = folder.write("m.jsonl", "{\"whole\": 1}\n{\"cut");
    add_line(file, false, "{}");
    EXPECT_EQ(read_whole_file(folder / "m.jsonl"), "{\"whole\": 1}\n{\"cut\n{}\n");
}

TEST(Manifest, PipesAreRefusedWithoutWaiting) {
    const TempFolder folder;
    const std::filesystem::path pipe = folder / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    for (const bool anew : {true, false}) {
        const Result<Manifest> manifest = Manifest::open(pipe, anew);
        ASSERT_FALSE(manifest);
        EXPECT_EQ(manifest.error().id, "E-OUT-CREATE");
    }
}

}  // namespace
}  // namespace obscura
