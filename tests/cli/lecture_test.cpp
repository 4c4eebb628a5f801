// tests/cli/lecture_test.cpp - every command of docs/lecture.md makes the promised image.
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

/// The same with few pixels, unless one of them is named, and scenes by their whole path.
std::vector<std::string> small_and_absolute(const std::vector<std::string>& command) {
    std::vector<std::string> out;
    const bool renders = command.front() == "render";
    for (size_t i = 0; i < command.size(); ++i) {
        if (renders && (command[i] == "--size" || command[i] == "--spp")) {
            ++i;
            continue;
        }
        const bool asset = command[i].rfind("assets/", 0) == 0;
        out.push_back(asset ? OBSCURA_SOURCE_DIR "/" + command[i] : command[i]);
    }
    if (renders) out.insert(out.end(), {"--size", "48x32", "--spp", "4"});
    return out;
}

/// The fraction of pixels that are nearly black.
double dark_fraction(const ReadImage& image) {
    const size_t channels = image.channels.size();
    size_t dark = 0;
    for (size_t i = 0; i < image.pixels.size(); i += channels) {
        const float* pixel = &image.pixels[i];
        dark += *std::max_element(pixel, pixel + std::min<size_t>(channels, 3)) < 0.04f ? 1U : 0U;
    }
    return static_cast<double>(dark * channels) / static_cast<double>(image.pixels.size());
}

class Lecture : public Cli {};

TEST_F(Lecture, EveryCommandMakesItsImage) {
    const auto commands = commands_of(read_text(fs::path(OBSCURA_SOURCE_DIR) / "docs/lecture.md"));
    EXPECT_GT(commands.size(), 8U);
    for (const std::vector<std::string>& command : commands) {
        SCOPED_TRACE(command[1] + " ... " + command.back());
        expect_result(run(small_and_absolute(command)), 0, "OK");
        EXPECT_TRUE(fs::exists(fs::path(OBSCURA_SOURCE_DIR) / "docs/lecture" / command.back()));
        if (command.front() != "render") continue;
        const auto image = read_image_file(folder_ / command.back());
        ASSERT_TRUE(image);
        const auto [least, most] = std::minmax_element(image->pixels.begin(), image->pixels.end());
        EXPECT_GT(*most - *least, 0.1f) << "something is to be seen";
        const bool lines = command.back() == "wires.png";  // white on black
        EXPECT_LT(dark_fraction(*image), lines ? 0.9 : 0.5) << "it is to be seen in most places";
    }
}

}  // namespace
}  // namespace obscura
