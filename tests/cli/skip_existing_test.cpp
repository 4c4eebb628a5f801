// tests/cli/skip_existing_test.cpp - finished frames are left alone; programs share a sequence.
// SPDX-License-Identifier: Apache-2.0
#include "base/work_lock.h"

#include "cli/cli.h"
#include "support/text_files.h"
#include <ctime>
#include <fcntl.h>
#include <future>
#include <set>
#include <sys/stat.h>

namespace obscura {
namespace {

using testing::HasSubstr;
using Texts = std::vector<std::string>;

class SkipExisting : public Cli {
protected:
    static Texts frames(const std::string& which = "1-3", const Texts& more = {}) {
        return joined({"--skip-existing", "--frames", which, "-o", "f.##.exr"}, more);
    }
    std::string text(const std::string& name) const { return read_text(folder_ / name); }
    bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

    /// Renders, and says how many images were left as they are.
    int skipped(const Texts& more) const {
        const ProgramRun got = render("box.gltf", more);
        expect_result(got, 0, "OK");
        return result_of(got).value_or(ResultLine{}).skipped;
    }
    void leave_lock(const std::string& name, double age_s) const {
        const std::string file = folder_.write(name, lock_text({"elsewhere", "", 7, "long ago"}));
        const timespec then = {std::time(nullptr) - static_cast<time_t>(age_s), 0};
        const timespec times[2] = {then, then};
        ASSERT_EQ(utimensat(AT_FDCWD, file.c_str(), times, 0), 0);
    }
    void expect_no_locks() const {
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
            EXPECT_EQ(entry.path().string().find(".lock"), std::string::npos) << entry.path();
    }
};

/// The frames that a program says it has written, one "n" each.
std::multiset<int> written_by(const ProgramRun& run) {
    static const std::regex form(R"(INFO frame (\d+) is written)");
    std::multiset<int> out;
    for (const std::string& line : lines_of(run.err)) {
        std::smatch match;
        if (std::regex_search(line, match, form)) out.insert(std::stoi(match[1]));
    }
    return out;
}

TEST_F(SkipExisting, WhatIsThereIsLeftAndWhatIsMissingIsRendered) {
    expect_result(render("box.gltf", {"--frames", "1-3", "-o", "f.##.exr"}), 0, "OK");
    const std::string second = text("f.02.exr");
    EXPECT_EQ(skipped(frames()), 3) << "rendered without the option";
    std::filesystem::remove(folder_ / "f.02.exr");
    const ProgramRun got = render("box.gltf", frames("1-3", {"--threads", "1", "--verbose"}));
    expect_result(got, 0, "OK");
    EXPECT_EQ(written_by(got), std::multiset<int>{2});
    EXPECT_THAT(got.err, HasSubstr("frame 1 is there and is left as it is"));
    EXPECT_TRUE(text("f.02.exr") == second);
    EXPECT_EQ(skipped(frames("1-4")), 3);
    EXPECT_EQ(skipped(frames("1,4,2-3")), 4);
    expect_no_locks();
}

TEST_F(SkipExisting, ByFingerprintAndNotByName) {
    EXPECT_EQ(skipped(frames()), 0);
    folder_.write("f.01.exr", "nonsense");
    const ProgramRun damaged = render("box.gltf", frames());
    EXPECT_EQ(written_by(damaged), std::multiset<int>{1});
    EXPECT_THAT(damaged.err, HasSubstr("frame 1 is rendered again: f.01.exr cannot be read"));
    const ProgramRun other = render("box.gltf", frames("1-3", {"--seed", "2"}));
    EXPECT_EQ(written_by(other).size(), 3U);
    EXPECT_THAT(other.err,
                HasSubstr("frame 2 is rendered again: f.02.exr has another fingerprint"));
    folder_.write("box.gltf", text("box.gltf") + " ");
    EXPECT_EQ(written_by(render("box.gltf", frames("1-3", {"--seed", "2"}))).size(), 3U);
    std::filesystem::copy(folder_ / "f.02.exr",
                          folder_ / "f.03.exr",
                          std::filesystem::copy_options::overwrite_existing);
    EXPECT_EQ(written_by(render("box.gltf", frames("1-3", {"--seed", "2"}))),
              std::multiset<int>{3});
}

TEST_F(SkipExisting, OneImageInEveryFileThatItHas) {
    const Texts outputs = {"-o",
                           "a.exr",
                           "-o",
                           "a.png",
                           "-o",
                           "a.jpg",
                           "-o",
                           "a.tif",
                           "--aov",
                           "normal",
                           "--exr-layout",
                           "separate",
                           "--segmentation",
                           "mask.png"};
    expect_result(render("quad.gltf", outputs), 0, "OK");
    const Texts again = joined(outputs, {"--skip-existing"});
    EXPECT_EQ(result_of(render("quad.gltf", again))->skipped, 1);
    for (const char* name :
         {"a.exr", "a.png", "a.jpg", "a.tif", "a.normal.exr", "mask.png", "mask.json"}) {
        const std::string before = text(name);
        for (const bool cut : {false, true}) {
            if (cut) {
                std::filesystem::resize_file(folder_ / name, before.size() - 2);
            } else {
                std::filesystem::remove(folder_ / name);
            }
            const ProgramRun got = render("quad.gltf", again);
            expect_result(got, 0, "OK");
            EXPECT_EQ(result_of(got)->skipped, 0) << name << ' ' << cut;
            EXPECT_EQ(text(name), before) << name;
        }
    }
    expect_no_locks();
}

TEST_F(SkipExisting, AnUnfinishedImageIsNotThere) {
    const Texts options = {"--size", "320x240", "--spp", "2048", "-o", "a.exr"};
    expect_result(render("box.gltf", joined(options, {"--time-limit", "0.5"})), 75, "E-TIME-LIMIT");
    ASSERT_TRUE(exists("a.exr"));
    const ProgramRun got =
        render("box.gltf", joined(options, {"--time-limit", "0.5", "--skip-existing"}));
    expect_result(got, 75, "E-TIME-LIMIT");
    EXPECT_THAT(got.err, HasSubstr("a.exr is rendered again: a.exr has no fingerprint"));
    expect_no_locks();
}

TEST_F(SkipExisting, WhatOthersHoldIsLeftUntilTheirLocksAreStale) {
    leave_lock("f.02.exr.lock", 0);
    const ProgramRun got = render("box.gltf", frames("1-4"));
    expect_result(got, 75, "E-LOCKED");
    EXPECT_THAT(got.err, HasSubstr("frame 2 is left to others"));
    EXPECT_EQ(written_by(got), (std::multiset<int>{1, 3, 4}));
    leave_lock("f.02.exr.lock", 70);
    const ProgramRun stale = render("box.gltf", frames("1-4"));
    expect_result(stale, 0, "OK");
    EXPECT_EQ(result_of(stale)->skipped, 3);
    EXPECT_THAT(stale.err, HasSubstr("frame 2: its lock was left by elsewhere, process 7"));
    expect_no_locks();
    leave_lock("a.exr.lock", 0);
    expect_result(render("box.gltf", {"--skip-existing", "-o", "a.exr"}), 75, "E-LOCKED");
}

TEST_F(SkipExisting, TwoProgramsShareASequence) {
    const Texts size = {"--size", "64x48", "--spp", "64", "--threads", "1"};
    expect_result(
        render("box.gltf", joined(size, {"--frames", "1-12", "-o", "whole.##.exr"})), 0, "OK");
    const Texts shared = joined(size, frames("1-12"));
    const auto start = [&] {
        return std::async(std::launch::async, [&] { return render("box.gltf", shared); });
    };
    auto one = start();
    auto other = start();
    std::multiset<int> written;
    for (const ProgramRun& run : {one.get(), other.get()}) {
        EXPECT_TRUE(run.code == 0 || run.code == 75) << run.err;
        const std::multiset<int> own = written_by(run);  // none, where the other is fast
        written.insert(own.begin(), own.end());
    }
    EXPECT_EQ(written, (std::multiset<int>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
    EXPECT_EQ(skipped(shared), 12);
    for (int i = 1; i <= 12; ++i) {
        const std::string end = (i < 10 ? ".0" : ".") + std::to_string(i) + ".exr";
        EXPECT_TRUE(text("f" + end) == text("whole" + end)) << end;
    }
    expect_no_locks();
}

TEST_F(SkipExisting, LocksGoWithSignalsAndThoseOfKilledProgramsAreStale) {
    const Texts options = {"--size",
                           "320x240",
                           "--threads",
                           "1",
                           "--spp",
                           "4096",
                           "--frames",
                           "1-2",
                           "-o",
                           "s.#.exr",
                           "--skip-existing"};
    for (const int signal : {SIGTERM, SIGUSR1, SIGKILL}) {
        ProgramSetup stopped = setup(small_render("box.gltf", options), folder_);
        bool was_locked = false;
        stopped.on_output = [&](const std::string& out, pid_t process) {
            static const std::regex has_begun("Progress: [1-9]");
            if (was_locked || !std::regex_search(out, has_begun)) return;
            was_locked = exists("s.1.exr.lock");
            kill(process, signal);
        };
        EXPECT_EQ(run_program_with(stopped).code, signal == SIGUSR1 ? 75 : 128 + signal);
        EXPECT_TRUE(was_locked);
        EXPECT_EQ(exists("s.1.exr.lock"), signal == SIGKILL);
    }
    const ProgramRun got = render("box.gltf", joined(options, {"--time-limit", "1"}));
    expect_result(got, 75, "E-TIME-LIMIT");
    EXPECT_THAT(got.err, HasSubstr("frame 1: its lock was left by "));
    expect_no_locks();
}

TEST_F(SkipExisting, WhatCannotTellIsRefused) {
    for (const Texts& options : std::vector<Texts>{{"-o", "a.avif"},
                                                   {"-o", "a.exr", "-o", "a.avif"},
                                                   {"-o", "-"},
                                                   {"-o", "a.exr", "--part", "1/2"}}) {
        expect_result(
            render("box.gltf", joined(options, {"--skip-existing"})), 64, "E-USAGE-CONFLICT");
    }
    EXPECT_THAT(render("box.gltf", {"--skip-existing", "-o", "a.avif"}).err,
                HasSubstr("EXR, PNG, JPEG, TIFF and WebP can"));
    expect_result(render("box.gltf", {"--priority", "high"}), 64, "E-USAGE-CHOICE");
}

TEST_F(SkipExisting, PartsOfASequenceSkipTheirOwnFrames) {
    const Texts part = frames("1-4", {"--part", "2/2"});
    EXPECT_EQ(written_by(render("box.gltf", part)), (std::multiset<int>{2, 4}));
    EXPECT_EQ(skipped(part), 2);
    EXPECT_EQ(skipped(frames("1-4")), 2);
    EXPECT_EQ(skipped(frames("1-4", {"--priority", "low"})), 4);
}

}  // namespace
}  // namespace obscura
