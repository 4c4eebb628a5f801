// tests/layout/layout_test.cpp - holds every source file of this tree to the rules in rules.h.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "layout/rules.h"
#include "layout/standard_names.h"
#include "layout/table_words.h"
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>

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

bool waits_to_be_mended(std::string_view file, std::string_view problem) {
    return std::any_of(not_yet_mended.begin(), not_yet_mended.end(), [&](std::string_view known) {
        const size_t colon = known.find(": ");
        return known.substr(0, colon) == file &&
               problem.find(known.substr(colon + 2)) != std::string_view::npos;
    });
}

void expect_no_problems(const std::vector<SourceFile>& files, Rule rule) {
    ASSERT_FALSE(files.empty());
    for (const SourceFile& file : files) {
        for (const std::string& problem : rule(file.path, file.text)) {
            if (!waits_to_be_mended(file.path, problem)) ADD_FAILURE() << problem;
        }
    }
}

/// Files outside of src/, named from the top: "tests/base/log_test.cpp".
std::vector<SourceFile> read_outside_src() {
    std::vector<SourceFile> all;
    for (const std::string folder : {"tests", "benchmarks", "include", "examples", "python"}) {
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

TEST(Layout, FilesIncludeTheStandardHeadersThatTheyUse) {
    const std::vector<SourceFile> files = read_sources(source_dir / "src");
    ASSERT_FALSE(files.empty());
    std::map<std::string, std::vector<Include>> includes;
    for (const SourceFile& file : files)
        includes[file.path] = find_includes(file.text);
    for (const SourceFile& file : files) {
        const std::set<std::string> headers = library_headers_of(file.path, includes);
        for (const std::string& problem : check_standard_names(file.path, file.text, headers))
            ADD_FAILURE() << problem;
    }
}

/// The rooms that src/CMakeLists.txt links to each room: "obscura_room(light ROOMS base math)" and
/// "target_link_libraries(obscura_stages PUBLIC obscura_base)".
std::map<std::string, std::set<std::string>> linked_rooms() {
    std::map<std::string, std::set<std::string>> linked;
    std::ifstream in(source_dir / "src" / "CMakeLists.txt");
    const std::string text(std::istreambuf_iterator<char>(in), {});
    const std::regex call(
        R"re((?:obscura_room\((\w+)|target_link_libraries\(obscura_(\w+)) ([^)]*)\))re");
    for (auto i = std::sregex_iterator(text.begin(), text.end(), call); i != std::sregex_iterator();
         ++i) {
        const std::string room = (*i)[1].matched ? (*i)[1] : (*i)[2];
        if (!room_number(room)) continue;
        std::istringstream words((*i)[3]);
        bool rooms_follow = (*i)[2].matched;
        for (std::string word; words >> word;) {
            if (word == "ROOMS") rooms_follow = true;
            if (word == "LIBRARIES" || word == "HEADERS") rooms_follow = false;
            if (word.starts_with("obscura_")) word.erase(0, 8);
            if (rooms_follow && room_number(word)) linked[room].insert(word);
        }
    }
    return linked;
}

TEST(Layout, RoomsLinkTheRoomsTheyInclude) {
    std::map<std::string, std::set<std::string>> included;
    for (const SourceFile& file : read_sources(source_dir / "src")) {
        const std::string room = file.path.substr(0, file.path.find('/'));
        for (const Include& include : find_includes(file.text)) {
            const std::string other = include.path.substr(0, include.path.find('/'));
            if (include.quoted && other != room) included[room].insert(other);
        }
    }
    std::map<std::string, std::set<std::string>> linked = linked_rooms();
    for (const std::string_view room : rooms) {
        EXPECT_EQ(linked[std::string(room)], included[std::string(room)])
            << "src/CMakeLists.txt links to " << room << " other rooms than it includes";
    }
}

/// A front end binds the library and has no part in rendering.
TEST(Layout, ThePythonModuleSeesThePublicHeadersAlone) {
    const std::regex allowed(R"re(obscura/\w+\.h|pybind11/\w+\.h|\w+|sys/types\.h|unistd\.h)re");
    const std::vector<SourceFile> files = read_sources(source_dir / "python" / "module");
    ASSERT_FALSE(files.empty());
    for (const SourceFile& file : files) {
        for (const Include& include : find_includes(file.text)) {
            const bool fits = include.quoted
                                  ? fs::exists(source_dir / "python" / "module" / include.path)
                                  : std::regex_match(include.path, allowed);
            EXPECT_TRUE(fits) << file.path << ":" << include.line << ": " << include.path;
        }
    }
}

TEST(Layout, EverySourceSaysWhatItIs) {
    expect_no_problems(read_sources(source_dir / "src"), check_head);
}

TEST(Layout, EverySourceIsShort) {
    expect_no_problems(read_sources(source_dir / "src"), check_sizes);
}

TEST(Layout, TablesAreReadByTheNamesOfTheirMembers) {
    expect_no_problems(read_sources(source_dir / "src"), check_table_words);
}

TEST(Layout, EveryLineFits) {
    expect_no_problems(read_sources(source_dir / "src"), check_columns);
    expect_no_problems(read_outside_src(), check_columns);
}

TEST(Layout, FunctionsTakeFewParameters) {
    expect_no_problems(read_sources(source_dir / "src"), check_parameters);
}

TEST(Layout, EveryTestSaysWhatItIs) {
    expect_no_problems(read_outside_src(), check_head);
}

TEST(Layout, EveryTestIsShort) {
    expect_no_problems(read_outside_src(), check_sizes);
}

}  // namespace
}  // namespace obscura::layout
