// tests/cli/texture_memory_test.cpp - textures in files give the same image; files are made once.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include "support/text_files.h"
#include <chrono>
#include <set>

namespace obscura {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Texts = std::vector<std::string>;

class TextureMemory : public Cli {
protected:
    static std::string showcase() { return OBSCURA_SOURCE_DIR "/assets/showcase/showcase.gltf"; }
    ProgramRun render_limited(const std::string& output, const Texts& more = {}) const {
        const Texts limit = {
            "--texture-memory", "1M", "--texture-cache", "cache", "--aov", "albedo,normal"};
        return render(showcase(), joined(joined(limit, more), {"-o", output}));
    }
    /// The files of the cache, with their times.
    std::set<std::pair<std::string, fs::file_time_type>> kept() const {
        std::set<std::pair<std::string, fs::file_time_type>> out;
        for (const auto& entry : fs::directory_iterator(folder_ / "cache"))
            out.emplace(entry.path().filename().string(), entry.last_write_time());
        return out;
    }
    std::string text(const std::string& name) const { return read_text(folder_ / name); }
};

TEST_F(TextureMemory, FilesGiveTheSameImage) {
    const Texts whole = {"--aov", "albedo,normal", "-o", "whole.exr"};
    expect_result(render(showcase(), whole), 0, "OK");
    expect_result(render_limited("a.exr"), 0, "OK");
    EXPECT_TRUE(text("a.exr") == text("whole.exr"));
    const auto made = kept();
    EXPECT_GT(made.size(), 4u);
    expect_result(render_limited("b.exr", {"--threads", "1"}), 0, "OK");
    EXPECT_TRUE(text("b.exr") == text("whole.exr"));
    EXPECT_TRUE(kept() == made) << "they are made once";
    // A file that was cut off is made again.
    const fs::path first = folder_ / "cache" / made.begin()->first;
    const std::string bytes = read_text(first);
    fs::resize_file(first, fs::file_size(first) - 1);
    expect_result(render_limited("c.exr"), 0, "OK");
    EXPECT_TRUE(text("c.exr") == text("whole.exr"));
    EXPECT_TRUE(read_text(first) == bytes);
}

TEST_F(TextureMemory, AnimationsKeepTheirFiles) {
    const Texts frames = {"--frames", "1-2", "--aov", "albedo", "-o"};
    expect_result(render(showcase(), joined(frames, {"whole.#.exr"})), 0, "OK");
    const Texts limit = {"--texture-memory", "1M", "--texture-cache", "cache"};
    expect_result(render(showcase(), joined(joined(limit, frames), {"a.#.exr"})), 0, "OK");
    EXPECT_TRUE(text("a.2.exr") == text("whole.2.exr"));
}

TEST_F(TextureMemory, WithRoomNothingIsWritten) {
    const Texts options = {"--texture-memory", "2G", "--texture-cache", "cache", "-o", "a.exr"};
    expect_result(render(showcase(), options), 0, "OK");
    EXPECT_FALSE(fs::exists(folder_ / "cache"));
}

TEST_F(TextureMemory, AFolderThatCannotBeWrittenIsNamed) {
    folder_.write("cache", "a file");
    const ProgramRun got = render_limited("a.exr");
    expect_result(got, 73, "E-OUT-CREATE");
    EXPECT_THAT(got.err, HasSubstr("cache/"));
    EXPECT_FALSE(fs::exists(folder_ / "a.exr"));
}

TEST_F(TextureMemory, WrongOptionsAreRefused) {
    expect_result(render(showcase(), {"--texture-cache", "cache"}), 64, "E-USAGE-CONFLICT");
    expect_result(render(showcase(), {"--texture-memory", "much"}), 64, "E-USAGE-NUMBER");
}

}  // namespace
}  // namespace obscura
