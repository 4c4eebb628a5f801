// tests/cli/signals_test.cpp - stopped by a signal: the right status, and old outputs as they were.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include <map>
#include <nlohmann/json.hpp>

namespace obscura {
namespace {

using testing::HasSubstr;
using Texts = std::vector<std::string>;

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
    EXPECT_EQ(got.signal, SIGTERM);
    expect_result(got, 143, "E-STOPPED");
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

TEST_F(Signals, ThoseOfFarmsHaveAResultLine) {
    for (const char* const moment : {"Progress: 0%", "Progress: [1-9]"}) {
        ProgramSetup program = long_render();
        send_at(program, SIGUSR1, moment);
        const ProgramRun got = run_program_with(program);
        EXPECT_EQ(got.signal, 0);
        expect_result(got, 75, "E-STOPPED");
        EXPECT_THAT(got.err, HasSubstr("SIGUSR1"));
        expect_untouched();
    }
}

TEST_F(Signals, AHangUpSavesACheckpointAndRenderingGoesOn) {
    for (const bool keeps : {false, true}) {
        Texts arguments = {"render", "box.gltf", "--size", "160x120", "--spp", "2048"};
        arguments = joined(arguments, {"--threads", "1", "--verbose"});
        if (keeps) arguments.emplace_back("--checkpoint");
        ProgramSetup program = setup(joined(arguments, {"-o", "new.exr"}), folder_);
        send_at(program, SIGHUP, "Progress: [1-9]");
        const ProgramRun got = run_program_with(program);
        expect_result(got, 0, "OK");
        EXPECT_EQ(got.err.find("checkpoint: ") != std::string::npos, keeps) << got.err;
        EXPECT_TRUE(std::filesystem::exists(folder_ / "new.exr"));
        EXPECT_FALSE(std::filesystem::exists(folder_ / "new.exr.checkpoint"));
    }
}

TEST_F(Signals, WithACheckpointEachOneKeepsWhatIsFinished) {
    for (const int signal : {SIGTERM, SIGINT, SIGUSR1}) {
        ProgramSetup program = long_render();
        program.arguments.emplace_back("--checkpoint");
        send_at(program, signal, "Progress: [1-9]");
        const ProgramRun got = run_program_with(program);
        expect_result(got, signal == SIGUSR1 ? 75 : 128 + signal, "E-STOPPED");
        EXPECT_THAT(got.err, HasSubstr("old.exr.checkpoint holds "));
        EXPECT_TRUE(std::filesystem::remove(folder_ / "old.exr.checkpoint"));
        expect_untouched();
    }
}

TEST_F(Signals, TheManifestHasTheCommandsExitCode) {
    const std::map<int, std::string> names = {
        {SIGTERM, "SIGTERM"}, {SIGINT, "SIGINT"}, {SIGUSR1, "SIGUSR1"}};
    for (const auto& [signal, name] : names) {
        ProgramSetup program = long_render();
        program.arguments = joined(program.arguments, {"--checkpoint", "--manifest", "m.jsonl"});
        send_at(program, signal, "Progress: [1-9]");
        const ProgramRun got = run_program_with(program);
        EXPECT_EQ(got.code, signal == SIGUSR1 ? 75 : 128 + signal);
        const auto line = nlohmann::json::parse(read_whole_file(folder_ / "m.jsonl"));
        EXPECT_EQ(line.at("exit_code"), got.code);
        EXPECT_EQ(line.at("id"), "E-STOPPED");
        EXPECT_THAT(line.at("message").get<std::string>(),
                    HasSubstr("stopped by " + name + "; old.exr.checkpoint holds "));
        EXPECT_TRUE(std::filesystem::remove(folder_ / "old.exr.checkpoint"));
    }
}

TEST_F(Signals, ASecondTerminationIsIgnored) {
    ProgramSetup program = long_render();
    program.arguments.emplace_back("--checkpoint");
    program.on_output = [](const std::string& out, pid_t process) {
        if (!std::regex_search(out, std::regex("Progress: [1-9]"))) return;
        kill(process, SIGTERM);
        kill(process, SIGTERM);
    };
    const ProgramRun got = run_program_with(program);
    EXPECT_EQ(got.signal, SIGTERM);
    expect_result(got, 143, "E-STOPPED");
    EXPECT_TRUE(std::filesystem::exists(folder_ / "old.exr.checkpoint"));
}

TEST_F(Signals, ASecondInterruptionEndsAtOnce) {
    ProgramSetup program = long_render();
    program.on_output = [](const std::string& out, pid_t process) {
        if (!std::regex_search(out, std::regex("Progress: [1-9]"))) return;
        kill(process, SIGINT);
        usleep(1000);
        kill(process, SIGINT);
    };
    const ProgramRun got = run_program_with(program);
    EXPECT_EQ(got.signal, SIGINT);
    expect_untouched();
}

}  // namespace
}  // namespace obscura
