// tests/cli/checkpoint_test.cpp - renderings that are cut short go on to the bits of unbroken ones.
// SPDX-License-Identifier: Apache-2.0
#include "base/stopwatch.h"

#include "cli/cli.h"
#include "support/text_files.h"
#include <chrono>
#include <cstdlib>
#include <random>
#include <thread>

namespace obscura {
namespace {

using testing::HasSubstr;
using Texts = std::vector<std::string>;

/// Rounds of killing; more of them by OBSCURA_KILL_ROUNDS=500.
int kill_rounds() {
    const char* const text = std::getenv("OBSCURA_KILL_ROUNDS");
    return text != nullptr ? std::atoi(text) : 20;
}

class Checkpoints : public Cli {
protected:
    /// A rendering of a second or so on one core, to a.exr with layers and masks.
    static Texts with_layers(const std::string& output = "a.exr",
                             const std::string& samples = "64") {
        return {"--size",
                "96x64",
                "--spp",
                samples,
                "--aov",
                "normal,depth,crypto_object,variance,sample_count",
                "--segmentation",
                "mask.png",
                "--denoise",
                "-o",
                output};
    }
    /// As long as it takes for a signal to come in the middle: lines of progress are a second
    /// apart.
    static Texts long_render(const std::string& output = "a.exr",
                             const std::string& samples = "512") {
        const Texts size = {"--size", "320x240", "--threads", "1", "--spp", samples};
        return joined(size, {"-o", output, "--checkpoint"});
    }
    ProgramSetup program(const Texts& more) const {
        return setup(small_render("box.gltf", more), folder_);
    }
    bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
    std::string text(const std::string& name) const { return read_text(folder_ / name); }

    /// Stops a rendering with USR1 in the middle, so that its checkpoint stays.
    void leave_checkpoint(const Texts& more) const {
        ProgramSetup stopped = program(more);
        send_at(stopped, SIGUSR1, "Progress: [1-9]");
        expect_result(run_program_with(stopped), 75, "E-STOPPED");
        ASSERT_TRUE(exists("a.exr.checkpoint"));
    }
};

/// Starts the program, kills it when `wait` returns; false: it had ended before.
template <class Wait>
bool run_and_kill(const ProgramSetup& setup, const Wait& wait) {
    const pid_t child = fork();
    if (child == 0) {
        const int nothing = open("/dev/null", O_WRONLY);
        run_program_detail::become(setup, nothing, nothing);
    }
    wait();
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    return WIFSIGNALED(status);
}

TEST_F(Checkpoints, KilledAtRandomMomentsItGoesOnToTheSameBits) {
    const Texts options = joined(with_layers(), {"--checkpoint", "--checkpoint-interval", "0.05"});
    const Stopwatch watch;
    expect_result(render("box.gltf", with_layers("whole.exr")), 0, "OK");
    const std::string mask = text("mask.png");
    std::mt19937 random(7);
    std::uniform_real_distribution<double> seconds(0.0, watch.seconds());
    int killed = 0;
    while (killed < kill_rounds()) {
        ProgramSetup one = program(options);
        one.arguments.insert(one.arguments.end() - 2,
                             {"--threads", std::to_string(1 + killed % 2)});
        const auto delay = std::chrono::duration<double>(seconds(random));
        if (run_and_kill(one, [&] { std::this_thread::sleep_for(delay); })) {
            ++killed;
            continue;
        }
        EXPECT_TRUE(text("a.exr") == text("whole.exr")) << "after kill " << killed;
        EXPECT_TRUE(text("mask.png") == mask);
        EXPECT_FALSE(exists("a.exr.checkpoint"));
        EXPECT_FALSE(exists("a.exr.checkpoint.1"));
    }
    expect_result(render("box.gltf", options), 0, "OK");
    EXPECT_TRUE(text("a.exr") == text("whole.exr"));
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
        const std::string name = entry.path().filename().string();
        // What kills left half-written is removed when it is old: see remove_stale_temporaries.
        const bool is_temporary = entry.path().extension() == ".part";
        EXPECT_TRUE(is_temporary || name.find("checkpoint") == std::string::npos) << name;
    }
}

TEST_F(Checkpoints, KilledAfterACheckpointItGoesOnFromThere) {
    const Texts options = long_render();
    const auto checkpoint_is_there = [&] {
        const Stopwatch watch;
        while (!exists("a.exr.checkpoint") && watch.seconds() < 60)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
    ASSERT_TRUE(run_and_kill(program(joined(options, {"--checkpoint-interval", "0.1"})),
                             checkpoint_is_there));
    ASSERT_TRUE(exists("a.exr.checkpoint"));
    expect_result(render("box.gltf", joined(options, {"--resume", "require"})), 0, "OK");
    expect_result(render("box.gltf", long_render("b.exr")), 0, "OK");
    EXPECT_TRUE(text("a.exr") == text("b.exr"));
}

TEST_F(Checkpoints, GoesOnFromWhatIsFinished) {
    const Texts options = long_render();
    leave_checkpoint(options);
    EXPECT_FALSE(exists("a.exr"));
    Texts verbose = joined(options, {"--stats", "a.json", "--tile-size", "24"});
    expect_result(render("box.gltf", verbose), 0, "OK");
    EXPECT_FALSE(exists("a.exr.checkpoint"));
    expect_result(render("box.gltf", long_render("b.exr")), 0, "OK");
    EXPECT_TRUE(text("a.exr") == text("b.exr"));
}

TEST_F(Checkpoints, OfOtherRenderingsAreRefusedWithWhatDiffers) {
    leave_checkpoint(long_render());
    const std::string before = text("a.exr.checkpoint");
    const ProgramRun options = render("box.gltf", joined(long_render(), {"--seed", "3"}));
    expect_result(options, 78, "E-RESUME-MIX");
    EXPECT_THAT(options.err, HasSubstr("--seed: nothing and 3"));
    const ProgramRun sets = render("box.gltf", joined(long_render(), {"--isa", "baseline"}));
    EXPECT_NE(sets.code, 0);
    constexpr int unsupported = 69;  // a build for its own machine
    if (sets.code != unsupported) {
        EXPECT_THAT(sets.err, HasSubstr("--isa: nothing and baseline"));
    }
    const std::string scene = text("box.gltf");
    folder_.write("box.gltf", scene + " ");
    const ProgramRun scenes = render("box.gltf", long_render());
    expect_result(scenes, 78, "E-RESUME-MIX");
    EXPECT_THAT(scenes.err, HasSubstr("the file box.gltf"));
    EXPECT_TRUE(text("a.exr.checkpoint") == before);
    folder_.write("box.gltf", scene);
    const Texts anew = joined(long_render(), {"--resume", "never", "--time-limit", "0.3"});
    expect_result(render("box.gltf", joined(anew, {"--seed", "3"})), 75, "E-TIME-LIMIT");
    const ProgramRun old = render("box.gltf", long_render());
    expect_result(old, 78, "E-RESUME-MIX");
    EXPECT_THAT(old.err, HasSubstr("--seed: 3 and nothing"));
}

TEST_F(Checkpoints, DamagedOnesAreNotUsed) {
    leave_checkpoint(long_render());
    const std::string whole = text("a.exr.checkpoint");
    const Texts required = joined(long_render(), {"--resume", "require", "--time-limit", "0.2"});
    std::mt19937 random(3);
    const size_t step = std::max<size_t>(1024, whole.size() / 1024 / 20 * 1024);
    for (size_t length = 0; length < whole.size(); length += step) {
        folder_.write("a.exr.checkpoint", whole.substr(0, length));
        expect_result(render("box.gltf", required), 74, "E-RESUME-NONE");
        std::string flipped = whole;
        char& byte = flipped[random() % whole.size()];
        byte = static_cast<char>(byte ^ (1 << random() % 8));
        folder_.write("a.exr.checkpoint", flipped);
        expect_result(render("box.gltf", required), 74, "E-RESUME-NONE");
    }
    std::filesystem::remove(folder_ / "a.exr.checkpoint");
    expect_result(render("box.gltf", required), 74, "E-RESUME-NONE");
    const Texts automatic = joined(long_render(), {"--time-limit", "0.4"});
    folder_.write("a.exr.checkpoint", whole.substr(0, 5000));
    const ProgramRun anew = render("box.gltf", automatic);
    expect_result(anew, 75, "E-TIME-LIMIT");
    EXPECT_THAT(anew.err, HasSubstr("WARN a.exr.checkpoint: not used to go on from"));
}

TEST_F(Checkpoints, TheOneBeforeADamagedOneIsUsed) {
    leave_checkpoint(long_render());
    std::filesystem::rename(folder_ / "a.exr.checkpoint", folder_ / "a.exr.checkpoint.1");
    const std::string before = text("a.exr.checkpoint.1");
    folder_.write("a.exr.checkpoint", before.substr(0, before.size() / 2));
    const ProgramRun got =
        render("box.gltf", joined(long_render(), {"--resume", "require", "--time-limit", "0.6"}));
    expect_result(got, 75, "E-TIME-LIMIT");
    EXPECT_THAT(got.err, HasSubstr("WARN a.exr.checkpoint: "));
    EXPECT_TRUE(text("a.exr.checkpoint.1") == before);  // a damaged one has not replaced it
    expect_result(render("box.gltf", long_render()), 0, "OK");
    expect_result(render("box.gltf", long_render("b.exr")), 0, "OK");
    EXPECT_TRUE(text("a.exr") == text("b.exr"));
}

TEST_F(Checkpoints, ThatCannotBeWrittenDoNotEndARendering) {
    const Texts options = {"--checkpoint=absent/a.film", "--checkpoint-interval", "0.05"};
    const ProgramRun got =
        render("box.gltf", joined({"--size", "64x64", "--spp", "2048", "-o", "a.exr"}, options));
    expect_result(got, 0, "OK");
    EXPECT_THAT(got.err, HasSubstr("WARN absent/a.film: no checkpoint: "));
}

TEST_F(Checkpoints, OfAPartAndOfAFrame) {
    const Texts part = joined(long_render("a.exr", "1536"), {"--part", "2/3"});
    ProgramSetup stopped = program(part);
    send_at(stopped, SIGUSR1, "Progress: [1-9]");
    expect_result(run_program_with(stopped), 75, "E-STOPPED");
    const std::string file = "a.exr.2-of-3.film";
    ASSERT_TRUE(exists(file + ".checkpoint"));
    const ProgramRun merged = run({"merge", file + ".checkpoint"});
    expect_result(merged, 78, "E-PART-SET");
    EXPECT_THAT(merged.err, HasSubstr("it is a checkpoint"));
    expect_result(render("box.gltf", part), 0, "OK");
    const std::string resumed = text(file);
    EXPECT_FALSE(exists(file + ".checkpoint"));
    expect_result(render("box.gltf", part), 0, "OK");
    EXPECT_TRUE(text(file) == resumed);

    const Texts size = {"--size", "320x240", "--threads", "1", "--spp", "512"};
    const Texts frames = joined(size, {"--frames", "1-2", "-o", "f.#.exr"});
    ProgramSetup second = program(joined(frames, {"--checkpoint"}));
    send_at(second, SIGTERM, "Progress: [6-9][0-9]");
    EXPECT_EQ(run_program_with(second).signal, SIGTERM);
    EXPECT_FALSE(exists("f.1.exr.checkpoint"));
    EXPECT_TRUE(exists("f.2.exr.checkpoint"));
    expect_result(render("box.gltf", joined(frames, {"--checkpoint"})), 0, "OK");
    const std::string frame = text("f.2.exr");
    expect_result(render("box.gltf", frames), 0, "OK");
    EXPECT_TRUE(text("f.2.exr") == frame);
}

TEST_F(Checkpoints, WrongOptionsAreRefused) {
    const std::vector<Texts> conflicts = {
        {"--resume", "auto"},
        {"--checkpoint-interval", "3"},
        {"--keep-checkpoint"},
        {"--checkpoint", "-o", "-"},
        {"--snapshot", "9", "--part", "1/2"},
        {"--snapshot", "9", "-o", "-"},
        {"--checkpoint=a.film", "--frames", "1-2", "-o", "a.#.exr"}};
    for (const Texts& options : conflicts)
        expect_result(render("box.gltf", options), 64, "E-USAGE-CONFLICT");
    expect_result(render("box.gltf", {"--checkpoint", "--resume", "maybe"}), 64, "E-USAGE-CHOICE");
    expect_result(
        render("box.gltf", {"--checkpoint=a.exr", "-o", "a.exr"}), 64, "E-USAGE-SAMEFILE");
}

TEST_F(Checkpoints, AtTheTimeLimitTheImageIsWholeAndMarked) {
    const Texts limit = {"--time-limit", "2.5"};
    const ProgramRun got = render("box.gltf", joined(long_render("a.exr", "4096"), limit));
    expect_result(got, 75, "E-TIME-LIMIT");
    EXPECT_THAT(got.err, HasSubstr("of 4096 samples a pixel"));
    EXPECT_TRUE(exists("a.exr.checkpoint"));
    const std::optional<ReadImage> image = read_image_file(folder_ / "a.exr");
    ASSERT_TRUE(image);
    const float done = image->spec.get_float_attribute("obscura:done", -1);
    EXPECT_GT(done, 0);
    EXPECT_LT(done, 1);
    EXPECT_NEAR(image->spec.get_float_attribute("obscura:samplesDone", -1), 4096 * done, 0.01);
    expect_result(render("box.gltf", long_render("b.exr", "256")), 0, "OK");
    const std::optional<ReadImage> whole = read_image_file(folder_ / "b.exr");
    ASSERT_TRUE(whole);
    EXPECT_EQ(whole->spec.find_attribute("obscura:done"), nullptr);
    double sum = 0;
    double sum_of_whole = 0;
    for (size_t i = 0; i < whole->pixels.size(); ++i) {
        sum += static_cast<double>(image->pixels[i]);
        sum_of_whole += static_cast<double>(whole->pixels[i]);
        // Alpha, with noise at edges: no tile is missing.
        if (i % 4 == 3) {
            EXPECT_NEAR(image->pixels[i], whole->pixels[i], 0.5) << i;
        }
    }
    EXPECT_NEAR(sum / sum_of_whole, 1, 0.01);
    expect_result(
        render("box.gltf", {"--time-limit", "0.05", "--size", "999x999"}), 75, "E-TIME-LIMIT");
}

TEST_F(Checkpoints, FewSamplesAtTheTimeLimitAreNotDenoised) {
    const Texts large = {"--size", "1600x1200", "--threads", "1", "--spp", "64", "--denoise"};
    const ProgramRun got =
        render("box.gltf", joined(large, {"-o", "a.exr", "--time-limit", "0.7"}));
    expect_result(got, 75, "E-TIME-LIMIT");
    EXPECT_THAT(got.err, HasSubstr("not denoised: there are too few samples"));
    const std::optional<ReadImage> image = read_image_file(folder_ / "a.exr");
    ASSERT_TRUE(image);
    EXPECT_EQ(image->spec.nchannels, 4);
}

TEST_F(Checkpoints, ThatAreKeptGoOnToMoreSamples) {
    const auto kept = [](const std::string& samples) {
        Texts out = with_layers("a.exr", samples);
        return joined(out, {"--checkpoint", "--keep-checkpoint"});
    };
    expect_result(render("box.gltf", kept("64")), 0, "OK");
    EXPECT_TRUE(exists("a.exr.checkpoint"));
    const Texts required = {"--resume", "require"};
    expect_result(render("box.gltf", joined(kept("150"), required)), 0, "OK");
    expect_result(render("box.gltf", with_layers("b.exr", "150")), 0, "OK");
    EXPECT_TRUE(text("a.exr") == text("b.exr"));
    const ProgramRun fewer = render("box.gltf", kept("100"));
    expect_result(fewer, 78, "E-RESUME-MIX");
    EXPECT_THAT(fewer.err, HasSubstr("--spp: 150 and 100"));
    const Texts last = joined(with_layers("a.exr", "200"), {"--checkpoint"});
    expect_result(render("box.gltf", joined(last, required)), 0, "OK");
    EXPECT_FALSE(exists("a.exr.checkpoint"));
    // With fewer samples than 64, texture look-ups are wider and random numbers others.
    expect_result(render("box.gltf", kept("32")), 0, "OK");
    const ProgramRun few = render("box.gltf", kept("64"));
    expect_result(few, 78, "E-RESUME-MIX");
    EXPECT_THAT(few.err, HasSubstr("--spp: 32 and 64"));
}

TEST_F(Checkpoints, OfAdaptiveSamplingGoOnToTheSameBits) {
    const auto adaptive = [](const std::string& output, const std::string& most = "16384") {
        const Texts size = {"--size", "160x120", "--threads", "1", "--spp", most};
        return joined(size,
                      {"--noise-target", "0.001", "--aov", "sample_count,normal", "-o", output});
    };
    const Texts kept = joined(adaptive("a.exr"), {"--checkpoint"});
    leave_checkpoint(kept);
    const ProgramRun others =
        render("box.gltf", joined(adaptive("a.exr", "8192"), {"--checkpoint"}));
    expect_result(others, 78, "E-RESUME-MIX");
    EXPECT_THAT(others.err, HasSubstr("--spp: 16384 and 8192"));
    const Texts required = {"--resume", "require"};
    expect_result(render("box.gltf", joined(kept, required)), 0, "OK");
    expect_result(render("box.gltf", adaptive("b.exr")), 0, "OK");
    EXPECT_TRUE(text("a.exr") == text("b.exr"));
}

TEST_F(Checkpoints, AdaptiveSamplingAtTheTimeLimitIsDenoised) {
    const Texts unbounded = {"--size", "40x30", "--spp", "1048576", "--noise-target", "0.0001"};
    const Texts limit = {"--time-limit", "2", "--denoise", "-o", "c.exr"};
    const ProgramRun got = render("box.gltf", joined(unbounded, limit));
    expect_result(got, 75, "E-TIME-LIMIT");
    EXPECT_THAT(got.err, HasSubstr("of at most 1048576 samples a pixel"));
    const std::optional<ReadImage> image = read_image_file(folder_ / "c.exr");
    ASSERT_TRUE(image);
    EXPECT_GT(image->spec.get_float_attribute("obscura:samplesDone", -1), 16);
    EXPECT_GT(image->spec.get_float_attribute("obscura:noise", -1), 0.0001f);
    EXPECT_NE(image->spec.find_attribute("obscura:denoise"), nullptr);
}

TEST_F(Checkpoints, OfAnIntegratorWithoutSamplesHoldTiles) {
    const Texts depth = {"--size", "96x64", "--integrator", "depth", "--checkpoint"};
    const Texts kept = {"--keep-checkpoint"};
    expect_result(render("box.gltf", joined(joined(depth, kept), {"-o", "a.exr"})), 0, "OK");
    ASSERT_TRUE(exists("a.exr.checkpoint"));
    const Texts required = {"--resume", "require", "-o", "a.exr"};
    const std::string before = text("a.exr");
    expect_result(render("box.gltf", joined(depth, required)), 0, "OK");
    EXPECT_TRUE(text("a.exr") == before);
    EXPECT_FALSE(exists("a.exr.checkpoint"));
}

TEST_F(Checkpoints, SnapshotsAreMarked) {
    ProgramSetup stopped = program(joined(with_layers("a.exr", "8192"), {"--snapshot", "0.1"}));
    stopped.on_output = [&](const std::string& out, pid_t process) {
        if (exists("a.exr") && exists("mask.png") &&
            std::regex_search(out, std::regex("Progress: [1-9]")))
            kill(process, SIGTERM);
    };
    EXPECT_EQ(run_program_with(stopped).signal, SIGTERM);
    const std::optional<ReadImage> image = read_image_file(folder_ / "a.exr");
    ASSERT_TRUE(image);
    EXPECT_GT(image->spec.get_float_attribute("obscura:done", -1), 0);
    EXPECT_GT(image->spec.get_float_attribute("obscura:samplesDone", -1), 0);
    EXPECT_TRUE(exists("mask.png"));
    expect_result(render("box.gltf", with_layers("whole.exr")), 0, "OK");
    expect_result(render("box.gltf", joined(with_layers(), {"--snapshot", "0.05"})), 0, "OK");
    EXPECT_TRUE(text("a.exr") == text("whole.exr"));
}

}  // namespace
}  // namespace obscura
