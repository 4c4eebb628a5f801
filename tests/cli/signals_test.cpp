// tests/cli/signals_test.cpp - stopped by a signal: the right status, and old outputs as they were.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"

namespace obscura {
namespace {

using testing::HasSubstr;

class Signals : public Cli {
protected:
    /// Minutes of work, so that a signal always comes in the middle.
    ProgramSetup long_render() const {
        return setup({"render",
                      "box.gltf",
                      "--size",
                      "640x480",
                      "--spp",
                      "512",
                      "-o",
                      "old.exr",
                      "--stats",
                      "s.json"},
                     folder_);
    }
    /// Sends the signal once, when the output holds a line that satisfies the pattern.
    static void send_at(ProgramSetup& program, int signal, const char* pattern) {
        program.on_output = [signal, form = std::regex(pattern), sent = false](
                                const std::string& out, pid_t process) mutable {
            if (sent || !std::regex_search(out, form)) return;
            sent = true;
            kill(process, signal);
        };
    }
    void expect_untouched() const {
        EXPECT_EQ(read_whole_file(folder_ / "old.exr"), "old");
        EXPECT_FALSE(std::filesystem::exists(folder_ / "s.json"));
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
            EXPECT_NE(entry.path().extension(), ".part") << entry.path();
        }
    }
    void SetUp() override {
        Cli::SetUp();
        folder_.write("old.exr", "old");
    }
};

TEST_F(Signals, TerminationWhileRendering) {
    ProgramSetup program = long_render();
    send_at(program, SIGTERM, "Progress: [1-9]");
    const ProgramRun got = run_program_with(program);
    EXPECT_EQ(got.signal, SIGTERM);
    expect_result(got, 143, "E-STOPPED");
    EXPECT_THAT(got.err, HasSubstr("SIGTERM"));
    EXPECT_THAT(got.out, testing::Not(HasSubstr("100%")));
    expect_untouched();
}

TEST_F(Signals, InterruptionWhileRendering) {
    ProgramSetup program = long_render();
    send_at(program, SIGINT, "Progress: [1-9]");
    const ProgramRun got = run_program_with(program);
    EXPECT_EQ(got.signal, SIGINT);
    expect_result(got, 130, "E-STOPPED");
    expect_untouched();
}

TEST_F(Signals, TerminationAtTheVeryStart) {
    ProgramSetup program = long_render();
    send_at(program, SIGTERM, "Progress: 0%");
    const ProgramRun got = run_program_with(program);
    EXPECT_EQ(got.code, 143);
    expect_untouched();
}

TEST_F(Signals, AnIgnoredInterruptionStaysIgnored) {
    ProgramSetup program =
        setup({"render", "box.gltf", "--size", "200x200", "--spp", "64", "-o", "new.exr"}, folder_);
    program.before_start = [] { std::signal(SIGINT, SIG_IGN); };
    send_at(program, SIGINT, "Progress: 0%");
    expect_result(run_program_with(program), 0, "OK");
    EXPECT_TRUE(std::filesystem::exists(folder_ / "new.exr"));
}

TEST_F(Signals, AClosedStandardOutputDoesNotEndTheRendering) {
    ProgramSetup program = setup(small_render("box.gltf", {"-o", "new.exr"}), folder_);
    program.before_start = [] {
        int ends[2];
        if (pipe(ends) != 0) _exit(126);
        close(ends[0]);
        dup2(ends[1], STDOUT_FILENO);
    };
    expect_result(run_program_with(program), 0, "OK");
    EXPECT_TRUE(std::filesystem::exists(folder_ / "new.exr"));
}

}  // namespace
}  // namespace obscura
