// tests/layout/layout_test.cpp - holds every source file of this tree to the rules in rules.h.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "layout/rules.h"
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace obscura::layout {
namespace {

namespace fs = std::filesystem;

const fs::path source_dir = OBSCURA_SOURCE_DIR;

struct SourceFile {
    std::string path;  ///< relative to the folder that was asked for, with /
    std::string text;
};

/// All .h and .cpp files below a folder, by name.
std::vector<SourceFile> read_sources(const fs::path& folder) {
    std::vector<SourceFile> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
        const fs::path extension = entry.path().extension();
        if (!entry.is_regular_file() || (extension != ".h" && extension != ".cpp")) continue;
        std::ifstream in(entry.path(), std::ios::binary);
        files.push_back({entry.path().lexically_relative(folder).generic_string(),
                         std::string(std::istreambuf_iterator<char>(in), {})});
    }
    std::sort(files.begin(), files.end(), [](const SourceFile& a, const SourceFile& b) {
        return a.path < b.path;
    });
    return files;
}

using Rule = Problems (*)(std::string_view file, std::string_view text);

void expect_no_problems(const std::vector<SourceFile>& files, Rule rule) {
    ASSERT_FALSE(files.empty());
    for (const SourceFile& file : files) {
        for (const std::string& problem : rule(file.path, file.text))
            ADD_FAILURE() << problem;
    }
}

/// Files of tests/ and benchmarks/, named from the top: "tests/base/log_test.cpp".
std::vector<SourceFile> read_outside_src() {
    std::vector<SourceFile> all;
    for (const std::string folder : {"tests", "benchmarks"}) {
        if (!fs::exists(source_dir / folder)) continue;
        for (SourceFile file : read_sources(source_dir / folder)) {
            file.path = folder + "/" + file.path;
            all.push_back(std::move(file));
        }
    }
    return all;
}

TEST(Layout, RoomsIncludeOnlyRoomsAboveAndOwnedLibraries) {
    expect_no_problems(read_sources(source_dir / "src"), check_includes);
}

TEST(Layout, EverySourceSaysWhatItIs) {
    expect_no_problems(read_sources(source_dir / "src"), check_head);
}

TEST(Layout, EverySourceIsShort) {
    expect_no_problems(read_sources(source_dir / "src"), check_sizes);
}

TEST(Layout, EveryTestSaysWhatItIs) {
    expect_no_problems(read_outside_src(), check_head);
}

TEST(Layout, EveryTestIsShort) {
    expect_no_problems(read_outside_src(), check_sizes);
}

}  // namespace
}  // namespace obscura::layout
