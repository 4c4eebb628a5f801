// tests/layout/errors_test.cpp - docs/errors.md lists the ids of the code, and tests raise them.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/text_files.h"
#include <filesystem>
#include <regex>
#include <set>
#include <string>

namespace obscura::layout {
namespace {

namespace fs = std::filesystem;
using Ids = std::set<std::string>;

const fs::path source_dir = OBSCURA_SOURCE_DIR;

/// Every match of `form`'s first group in the files below a folder.
Ids ids_below(const fs::path& folder, const std::string& form, const fs::path& but = {}) {
    const std::regex pattern(form);
    Ids ids;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
        const fs::path extension = entry.path().extension();
        if (extension != ".h" && extension != ".cpp") continue;
        if (!but.empty() && entry.path().parent_path() == but) continue;
        const std::string text = read_text(entry.path());
        for (auto i = std::sregex_iterator(text.begin(), text.end(), pattern);
             i != std::sregex_iterator();
             ++i) {
            ids.insert((*i)[1]);
        }
    }
    return ids;
}

/// Images that are environments fail by the same functions, with E-ENV- in place of E-IMG-.
bool is_renamed(const std::string& id, const Ids& code) {
    return id.starts_with("E-ENV-") && code.count("E-IMG-" + id.substr(6)) != 0;
}

Ids code_ids() {
    Ids ids = ids_below(source_dir / "src", R"re("(E-[A-Z0-9]+(?:-[A-Z0-9]+)*)")re");
    for (const char* family : {"E-IMG", "E-ENV"})  // which the image's size completes
        ids.erase(family);
    return ids;
}

/// The first column of the tables, each id once.
Ids listed_ids() {
    const std::string text = read_text(source_dir / "docs" / "errors.md");
    const std::regex row(R"re(\n\| `(E-[A-Z0-9-]+)` \| [0-9, ]+ \| [^|]+ \| [^|]+ \|)re");
    Ids ids;
    for (auto i = std::sregex_iterator(text.begin(), text.end(), row); i != std::sregex_iterator();
         ++i) {
        EXPECT_TRUE(ids.insert((*i)[1]).second) << (*i)[1] << " is listed twice";
    }
    return ids;
}

TEST(ErrorIds, TheTableListsThoseOfTheCodeAndNoOthers) {
    const Ids code = code_ids();
    const Ids listed = listed_ids();
    EXPECT_GT(code.size(), 100U);
    for (const std::string& id : code)
        EXPECT_EQ(listed.count(id), 1U) << id << " is not in docs/errors.md";
    for (const std::string& id : listed)
        EXPECT_TRUE(code.count(id) != 0 || is_renamed(id, code)) << id << " is nowhere in src/";
}

TEST(ErrorIds, EachIsRaisedByATest) {
    const Ids raised = ids_below(source_dir / "tests",
                                 R"re((E-[A-Z0-9]+(?:-[A-Z0-9]+)*))re",
                                 source_dir / "tests" / "layout");
    for (const std::string& id : listed_ids())
        EXPECT_EQ(raised.count(id), 1U) << id << " is raised by no test";
}

}  // namespace
}  // namespace obscura::layout
