// tests/base/rescued_file_test.cpp - what cannot be written is tried again, and copied elsewhere.
// SPDX-License-Identifier: Apache-2.0
#include "base/rescued_file.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <gmock/gmock.h>
#include <iterator>
#include <string>
#include <string_view>
#include <thread>
#include <unistd.h>

namespace obscura {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::span<const std::byte> pixels_of(std::string_view text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

std::string text_in(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

class RescuedFile : public testing::Test {
protected:
    void SetUp() override {
        root_ = fs::temp_directory_path() / ("rescue-" + std::to_string(::getpid()));
        fs::create_directories(root_ / "tmp");
        before_ = std::getenv("TMPDIR") != nullptr ? std::getenv("TMPDIR") : "";
        ::setenv("TMPDIR", (root_ / "tmp").c_str(), 1);
    }
    void TearDown() override {
        before_.empty() ? ::unsetenv("TMPDIR") : ::setenv("TMPDIR", before_.c_str(), 1);
        fs::remove_all(root_);
    }

    fs::path copy() const {
        return root_ / "tmp" / ("shot.0001." + std::to_string(::getpid()) + ".exr");
    }

    fs::path root_;
    std::string before_;
};

TEST_F(RescuedFile, IsAnOrdinaryFileWhereAllIsWell) {
    ASSERT_TRUE(write_or_rescue(root_ / "shot.exr", pixels_of("pixels"), {}));
    EXPECT_EQ(text_in(root_ / "shot.exr"), "pixels");
    EXPECT_TRUE(fs::is_empty(root_ / "tmp"));
}

TEST_F(RescuedFile, LeavesACopyWhenItsFolderHasGone) {
    const auto lost = write_or_rescue(root_ / "gone" / "shot.0001.exr", pixels_of("pixels"), {});
    ASSERT_FALSE(lost);
    EXPECT_EQ(lost.error().code, ExitCode::io_error);
    EXPECT_EQ(lost.error().id, "E-OUT-WRITE");
    EXPECT_THAT(lost.error().message, HasSubstr("there is no folder"));
    EXPECT_THAT(lost.error().message, HasSubstr("a copy is " + copy().string()));
    EXPECT_EQ(text_in(copy()), "pixels");
}

TEST_F(RescuedFile, SaysSoWhenThereIsNoCopyEither) {
    ::setenv("TMPDIR", (root_ / "nowhere").c_str(), 1);
    const auto no_folder = write_or_rescue(root_ / "gone" / "shot.exr", pixels_of("x"), {});
    ASSERT_FALSE(no_folder);
    EXPECT_THAT(no_folder.error().message, HasSubstr("set TMPDIR"));
    ::setenv("TMPDIR", root_.c_str(), 1);
    fs::create_directory(root_ / "shot.exr");  // a folder in the way, in the only place there is
    const auto same = write_or_rescue(root_ / "shot.exr", pixels_of("x"), {});
    ASSERT_FALSE(same);
    EXPECT_THAT(same.error().message, HasSubstr("set TMPDIR"));
}

TEST_F(RescuedFile, IsTriedAgain) {
    const fs::path folder = root_ / "late";
    std::thread mounts([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(30));
        fs::create_directory(folder);
    });
    const auto written = write_or_rescue(
        folder / "shot.exr", pixels_of("pixels"), {.retries = 12, .first_wait_s = 0.02});
    mounts.join();
    ASSERT_TRUE(written);
    EXPECT_EQ(text_in(folder / "shot.exr"), "pixels");
    EXPECT_TRUE(fs::is_empty(root_ / "tmp"));
}

TEST_F(RescuedFile, IsNotTriedAgainOnceStopped) {
    const std::atomic<bool> stop = true;
    const auto lost = write_or_rescue(root_ / "gone" / "shot.0001.exr",
                                      pixels_of("pixels"),
                                      {.retries = 1000, .first_wait_s = 1e6, .stop = &stop});
    ASSERT_FALSE(lost);
    EXPECT_EQ(text_in(copy()), "pixels");
}

}  // namespace
}  // namespace obscura
