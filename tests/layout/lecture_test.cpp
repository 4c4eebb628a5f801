// tests/layout/lecture_test.cpp - every file, function and test that docs/lecture.md names exists.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/text_files.h"
#include <regex>
#include <set>

namespace obscura::layout {
namespace {

namespace fs = std::filesystem;

const fs::path source_dir = OBSCURA_SOURCE_DIR;

/// Matches of `form`'s first group.
std::vector<std::string> all_matches(const std::string& text, const std::string& form) {
    const std::regex pattern(form);
    std::vector<std::string> found;
    for (auto i = std::sregex_iterator(text.begin(), text.end(), pattern);
         i != std::sregex_iterator();
         ++i) {
        found.push_back((*i)[1]);
    }
    return found;
}

std::string all_sources(const fs::path& folder) {
    std::string text;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
        const fs::path extension = entry.path().extension();
        if (extension == ".h" || extension == ".cpp") text += read_text(entry.path());
    }
    return text;
}

TEST(LectureDocument, ItsFilesExist) {
    const std::string text = read_text(source_dir / "docs" / "lecture.md");
    const auto files = all_matches(text, R"re(`((?:src|tests|assets|docs)/[^` ]+)`)re");
    EXPECT_GT(files.size(), 20U);
    for (const std::string& file : files)
        EXPECT_TRUE(fs::exists(source_dir / file)) << file;
    const std::string exercises = read_text(source_dir / "docs" / "lecture" / "exercises.md");
    for (const std::string& link : all_matches(text, R"re(\]\(([^)#]+)(?:#[^)]*)?\))re"))
        EXPECT_TRUE(fs::exists(source_dir / "docs" / link)) << link;
    for (const std::string& link : all_matches(exercises, R"re(\]\(([^)#]+)(?:#[^)]*)?\))re"))
        EXPECT_TRUE(fs::exists(source_dir / "docs" / "lecture" / link)) << link;
}

/// Formulas are numbered from (1) on where they stand, and each has a row in the table of all.
TEST(LectureDocument, ItsFormulasAreNumberedAndListed) {
    const std::string text = read_text(source_dir / "docs" / "lecture.md");
    const size_t table = text.find("## All formulas");
    ASSERT_NE(table, std::string::npos);
    const auto shown = all_matches(text.substr(0, table), R"re(\n    [^\n]* {4,}\((\d+)\)\n)re");
    const auto listed = all_matches(text.substr(table), R"re(\n\| \((\d+)\) \|)re");
    EXPECT_GE(shown.size(), 17U);
    for (size_t i = 0; i < shown.size(); ++i)
        EXPECT_EQ(shown[i], std::to_string(i + 1));
    EXPECT_EQ(listed, shown);
}

TEST(LectureDocument, ItsFunctionsExistInTheFilesNamedBesideThem) {
    // A function belongs to the file that its paragraph names.
    std::string paragraph;
    int functions = 0;
    for (const std::string& line : split_lines(read_text(source_dir / "docs" / "lecture.md"))) {
        paragraph += line + " ";
        if (!line.empty()) continue;
        std::string code;
        for (const std::string& file : all_matches(paragraph, R"re(`(src/[^` ]+)`)re"))
            code += read_text(source_dir / file);
        for (const std::string& name : all_matches(paragraph, R"re(`([a-z_]+)\(\)`)re")) {
            EXPECT_NE(code.find(name + "("), std::string::npos) << name << ": " << paragraph;
            ++functions;
        }
        paragraph.clear();
    }
    EXPECT_GT(functions, 18);
}

TEST(LectureDocument, ItsTestsExist) {
    const std::string text = read_text(source_dir / "docs" / "lecture.md");
    const std::string code = all_sources(source_dir / "tests");
    std::set<std::string> tests;
    for (const std::string& name : all_matches(code, R"re(TEST(?:_F|_P)?\((\w+, \w+)\))re"))
        tests.insert(name);
    const auto named = all_matches(text, R"re(`([A-Z][A-Za-z]+\.[A-Z][A-Za-z]+)`)re");
    EXPECT_GT(named.size(), 20U);
    for (std::string name : named) {
        name.replace(name.find('.'), 1, ", ");
        EXPECT_TRUE(tests.count(name) == 1) << name;
    }
}

}  // namespace
}  // namespace obscura::layout
