// tests/cli/lecture_test.cpp - every command of docs/lecture.md makes the picture that it promises.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include "support/text_files.h"

namespace obscura {
namespace {

namespace fs = std::filesystem;

/// The commands without `obscura`, in words; lines that end with a backslash go on.
std::vector<std::vector<std::string>> commands_of(const std::string& document) {
    std::vector<std::vector<std::string>> commands;
    bool goes_on = false;
    for (const std::string& line : split_lines(document)) {
        if (!goes_on && line.rfind("obscura ", 0) != 0) continue;
        if (!goes_on) commands.emplace_back();
        goes_on = false;
        std::istringstream words(line);
        for (std::string word; words >> word;) {
            goes_on = word == "\\";
            if (!goes_on && word != "obscura") commands.back().push_back(word);
        }
    }
    return commands;
}

/// The same with few pixels, and scenes by their whole path.
std::vector<std::string> small_and_absolute(const std::vector<std::string>& command) {
    std::vector<std::string> out;
    for (size_t i = 0; i < command.size(); ++i) {
        if (command[i] == "--size") {
            ++i;
            continue;
        }
        const bool asset = command[i].rfind("assets/", 0) == 0;
        out.push_back(asset ? OBSCURA_SOURCE_DIR "/" + command[i] : command[i]);
    }
    out.insert(out.end(), {"--size", "48x32", "--spp", "1"});
    return out;
}

class Lecture : public Cli {};

TEST_F(Lecture, EveryCommandMakesItsPicture) {
    const auto commands = commands_of(read_text(fs::path(OBSCURA_SOURCE_DIR) / "docs/lecture.md"));
    EXPECT_GT(commands.size(), 8U);
    for (const std::vector<std::string>& command : commands) {
        SCOPED_TRACE(command[1] + " ... " + command.back());
        expect_result(run(small_and_absolute(command)), 0, "OK");
        const auto picture = read_picture(folder_ / command.back());
        ASSERT_TRUE(picture);
        const auto [least, most] =
            std::minmax_element(picture->pixels.begin(), picture->pixels.end());
        EXPECT_GT(*most - *least, 0.1f) << "something is to be seen";
    }
}

}  // namespace
}  // namespace obscura
