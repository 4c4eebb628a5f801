// tests/layout/retired_words_test.cpp - no file uses a retired word, and one that did would fail.
// SPDX-License-Identifier: Apache-2.0
#include "layout/retired_words.h"

#include <gtest/gtest.h>

#include "support/text_files.h"
#include <filesystem>
#include <gmock/gmock.h>
#include <set>

namespace obscura::layout {
namespace {

namespace fs = std::filesystem;

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const fs::path source_dir = OBSCURA_SOURCE_DIR;

bool is_checked(const fs::path& file) {
    const fs::path extension = file.extension();
    const bool own = file.filename().string().starts_with("retired_words");
    return !own && (extension == ".h" || extension == ".cpp" || extension == ".md");
}

/// All sources and documents, from the top of the tree; not CHANGELOG.md, which tells the past.
std::set<fs::path> checked_files() {
    std::set<fs::path> files = {"README.md"};
    for (const char* folder :
         {"src", "tests", "docs", "benchmarks", "examples", "python", "tools"}) {
        if (!fs::exists(source_dir / folder)) continue;
        for (const fs::directory_entry& entry :
             fs::recursive_directory_iterator(source_dir / folder)) {
            if (entry.is_regular_file() && is_checked(entry.path())) {
                files.insert(entry.path().lexically_relative(source_dir));
            }
        }
    }
    return files;
}

TEST(RetiredWords, AreNowhereInTheTree) {
    const std::set<fs::path> files = checked_files();
    EXPECT_GT(files.size(), 700U);
    for (const fs::path& file : files) {
        const std::string name = file.generic_string();
        for (const std::string& text : {name, read_text(source_dir / file)}) {
            for (const std::string& problem : check_retired_words(name, text))
                ADD_FAILURE() << problem;
        }
    }
}

TEST(RetiredWords, KeptOnesAreStillThere) {
    for (const KeptWord& kept : kept_words) {
        bool found = false;
        for (const fs::path& file : checked_files()) {
            if (!file.generic_string().starts_with(kept.file)) continue;
            found = found || read_text(source_dir / file).find(kept.word) != std::string::npos;
        }
        EXPECT_TRUE(found) << kept.file << ": " << kept.word << " needs no exception any more";
        EXPECT_FALSE(kept.reason.empty()) << kept.file << ": " << kept.word;
    }
}

TEST(RetiredWords, ASeededSampleFails) {
    EXPECT_THAT(check_retired_words("src/stages/x.h",
                                    "// The corridor's first stage.\n"
                                    "void trace(const PathRows& paths);\n"
                                    "constexpr int most_bounces = 8;  // planes without end\n"),
                ElementsAre("src/stages/x.h:1: `corridor` is retired: write wavefront pipeline",
                            "src/stages/x.h:2: `PathRows` is retired: write PathColumns",
                            "src/stages/x.h:3: `most_bounces` is retired: write max_*",
                            HasSubstr("src/stages/x.h:3: `without end` is retired")));
    EXPECT_THAT(check_retired_words("docs/design.md", "Between the `doors`\n"),
                ElementsAre(HasSubstr("docs/design.md:1: `doors`")));
    EXPECT_THAT(check_retired_words("src/a/b.cpp", "f(R\"(x)\", mover);"),
                ElementsAre(HasSubstr("write dynamic group")));
    EXPECT_THAT(
        check_retired_words("src/a/b.cpp", "render_quantity_tile(of_mover_, stroke_radii);"),
        SizeIs(3));
    EXPECT_THAT(check_retired_words("src/stages/doors.h", "src/stages/doors.h"), SizeIs(1));
}

TEST(RetiredWords, EachEntryFindsItsOwnPattern) {
    for (const RetiredWord& retired : retired_words) {
        std::string sample;
        for (const char c : retired.pattern) {
            if (c == '*') sample += "x1_";
            if (c != '*') sample += c;
        }
        const std::string file(retired.where.substr(0, retired.where.find(' ')));
        EXPECT_FALSE(check_retired_words(file, sample).empty()) << retired.pattern;
        EXPECT_FALSE(retired.instead.empty()) << retired.pattern;
    }
}

TEST(RetiredWords, OtherWordsAndLiteralsAreFine) {
    EXPECT_THAT(check_retired_words("src/stages/x.cpp",
                                    "columns(PathColumns{}, \"most_rays\", 'c', 1'000);\n"
                                    "indoors(almost_all, at_least, removers);\n"
                                    "// At most so many; a loop without ends.\n"),
                IsEmpty());
}

TEST(RetiredWords, PatternsMatchWholeWords) {
    EXPECT_TRUE(matches("most_*", "most_rays"));
    EXPECT_TRUE(matches("most_*", "most_"));
    EXPECT_TRUE(matches("*uantity", "render_quantity"));
    EXPECT_TRUE(matches("a*c*", "abcd"));
    EXPECT_FALSE(matches("most_*", "almost_all"));
    EXPECT_FALSE(matches("doors", "outdoors"));
    EXPECT_FALSE(matches("*uantity", "quantity_of"));
}

}  // namespace
}  // namespace obscura::layout
