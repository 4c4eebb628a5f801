// tests/cli/parts_test.cpp - parts of a picture merge to the bits of one rendering.
// SPDX-License-Identifier: Apache-2.0
#include "cli/cli.h"
#include "support/text_files.h"

namespace obscura {
namespace {

using testing::HasSubstr;
using Texts = std::vector<std::string>;

std::string part_name(const std::string& output, int index, int count) {
    return output + "." + std::to_string(index) + "-of-" + std::to_string(count) + ".film";
}

class Parts : public Cli {
protected:
    /// Renders one part into `output`'s part file.
    void part(const std::string& output, int index, int count, Texts more = {}) const {
        const std::string text = std::to_string(index) + "/" + std::to_string(count);
        more.insert(more.end(), {"-o", output, "--part", text});
        expect_result(render("box.gltf", more), 0, "OK");
    }
    /// Renders all parts and merges them, the last one first; each with threads of its own number.
    ProgramRun merged(const std::string& output, int count, const Texts& more) const {
        Texts arguments = {"merge"};
        for (int index = count; index >= 1; --index) {
            Texts own = more;
            own.insert(own.end(), {"--threads", std::to_string(1 + index % 2)});
            part(output, index, count, own);
            arguments.push_back(part_name(output, index, count));
        }
        return run(arguments);
    }
    void expect_same_bits(const std::string& a, const std::string& b) const {
        EXPECT_TRUE(read_text(folder_ / a) == read_text(folder_ / b)) << a << " and " << b;
        EXPECT_FALSE(read_text(folder_ / a).empty());
    }
    /// Compares merged parts with one rendering, for several numbers of parts.
    ///
    /// In      of_parts: options that the parts alone have
    void expect_equal_bits(const Texts& more,
                           const Texts& files,
                           const Texts& of_parts = {}) const {
        Texts whole = more;
        whole.insert(whole.end(), {"-o", "a.exr"});
        expect_result(render("box.gltf", whole), 0, "OK");
        for (const std::string& file : files)
            std::filesystem::rename(folder_ / file, folder_ / ("whole." + file));
        for (const int count : {1, 2, 3, 7}) {
            expect_result(merged("a.exr", count, joined(more, of_parts)), 0, "OK");
            for (const std::string& file : files)
                expect_same_bits(file, "whole." + file);
        }
    }
};

TEST_F(Parts, MergeWithTheExposureThatWasMetered) {
    const Texts dim = {"--env", "white", "--env-intensity", "0.1", "--lights", "off"};
    expect_result(render("box.gltf", joined(dim, {"-o", "plain.png"})), 0, "OK");
    const Texts metered = joined(dim, {"--exposure", "auto"});
    expect_result(render("box.gltf", joined(metered, {"-o", "whole.png"})), 0, "OK");
    const ProgramRun merge = merged("a.png", 2, metered);
    expect_result(merge, 0, "OK");
    EXPECT_THAT(merge.err, Not(HasSubstr("metered"))) << "parts know the number";
    expect_same_bits("a.png", "whole.png");
    EXPECT_NE(read_text(folder_ / "whole.png"), read_text(folder_ / "plain.png"));
}

TEST_F(Parts, MergeToTheBitsOfOneRendering) {
    expect_equal_bits({"--size", "40x37", "--crop", "3,2,31,33"}, {"a.exr"});
    expect_equal_bits({"--integrator", "normal"}, {"a.exr"});
    expect_equal_bits({"--overscan", "3"}, {"a.exr"});
    expect_equal_bits({"--size", "40x37", "--spp", "18", "--checkpoint"}, {"a.exr"});
}

TEST_F(Parts, MergeLayersCryptomatteSegmentationAndDenoising) {
    expect_equal_bits({"--size",
                       "40x37",
                       "--spp",
                       "8",
                       "--aov",
                       "normal,depth,crypto_object,crypto_material,variance,sample_count",
                       "--catcher",
                       "ground",
                       "--segmentation",
                       "mask.png",
                       "--crypto-manifest",
                       "names.json",
                       "--denoise"},
                      {"a.exr", "mask.png", "mask.json", "names.json"});
}

TEST_F(Parts, OfSamplesMergeToTheBitsOfOneRendering) {
    const Texts by_samples = {"--part-by", "samples"};
    const Texts size = {"--size", "40x37", "--spp"};
    for (const char* const spp : {"7", "16", "100"})
        expect_equal_bits(joined(size, {spp}), {"a.exr"}, by_samples);
    expect_equal_bits(joined(size, {"50", "--checkpoint"}), {"a.exr"}, by_samples);
    expect_equal_bits(joined(size,
                             {"90",
                              "--aov",
                              "normal,depth,position,crypto_object,crypto_material,variance",
                              "--aov",
                              "cost,sample_count,diffuse_direct,emission,shadow,id_node",
                              "--light-groups",
                              "each",
                              "--catcher",
                              "ground",
                              "--segmentation",
                              "mask.png",
                              "--denoise"}),
                      {"a.exr", "mask.png", "mask.json"},
                      by_samples);
}

TEST_F(Parts, OfSamplesAreTold) {
    const Texts samples = {"--part-by", "samples", "--spp", "32"};
    const Texts small = joined({"-o", "a.exr", "--size", "40x37"}, samples);
    const ProgramRun none = render("box.gltf", joined(small, {"--part", "1/3"}));
    expect_result(none, 0, "OK");
    EXPECT_THAT(none.err, HasSubstr("part 1 of 3 has no samples: 32 make 2 blocks of 16"));
    part("a.exr", 2, 3, {"--size", "40x37", "--spp", "32"});
    part("a.exr", 3, 3, joined({"--size", "40x37"}, samples));
    const ProgramRun mixed = run(
        {"merge", part_name("a.exr", 1, 3), part_name("a.exr", 2, 3), part_name("a.exr", 3, 3)});
    expect_result(mixed, 78, "E-PART-MIX");
    EXPECT_THAT(mixed.err, HasSubstr("--part-by: tiles and samples"));
    const auto refused = [&](const Texts& more) {
        expect_result(render("box.gltf", joined(small, joined({"--part", "1/2"}, more))),
                      64,
                      "E-USAGE-CONFLICT");
    };
    refused({"--integrator", "normal"});
    refused({"--snapshot", "5"});
    refused({"--frames", "1-2", "-o", "f.#.exr"});
}

TEST_F(Parts, MergeWritesOtherOutputs) {
    expect_result(render("box.gltf", {"-o", "whole.png"}), 0, "OK");
    part("a.exr", 1, 2);
    part("a.exr", 2, 2);
    const Texts arguments = {
        "merge", part_name("a.exr", 1, 2), part_name("a.exr", 2, 2), "-o", "b.png"};
    expect_result(run(arguments), 0, "OK");
    expect_same_bits("b.png", "whole.png");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.exr"));
}

TEST_F(Parts, GapsAndRepetitionsAreRefused) {
    part("a.exr", 1, 3);
    part("a.exr", 3, 3);
    const std::string first = part_name("a.exr", 1, 3);
    const std::string third = part_name("a.exr", 3, 3);
    const ProgramRun gap = run({"merge", third, first});
    expect_result(gap, 78, "E-PART-SET");
    EXPECT_THAT(gap.err, HasSubstr("part 2 of 3 is missing"));
    const ProgramRun twice = run({"merge", first, third, first});
    expect_result(twice, 78, "E-PART-SET");
    EXPECT_THAT(twice.err, HasSubstr("part 1 of 3 is there more than once: " + first));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.exr"));
    expect_result(run({"merge"}), 64, "E-USAGE-CONFLICT");
}

TEST_F(Parts, MixturesAreRefusedWithWhatDiffers) {
    part("a.exr", 1, 2);
    part("a.exr", 2, 2, {"--seed", "7"});
    const Texts both = {"merge", part_name("a.exr", 1, 2), part_name("a.exr", 2, 2)};
    const ProgramRun options = run(both);
    expect_result(options, 78, "E-PART-MIX");
    EXPECT_THAT(options.err, HasSubstr("--seed: nothing and 7"));
    part("a.exr", 2, 2);
    folder_.write("box.gltf", read_text(folder_ / "box.gltf") + " ");
    const ProgramRun later = run(both);
    expect_result(later, 78, "E-PART-MIX");
    EXPECT_THAT(later.err, HasSubstr("the file box.gltf"));
    part("a.exr", 2, 2);
    const ProgramRun scenes = run(both);
    expect_result(scenes, 78, "E-PART-MIX");
    EXPECT_THAT(scenes.err, HasSubstr("the file box.gltf"));
    part("a.exr", 3, 3);
    const ProgramRun counts = run({"merge", part_name("a.exr", 2, 2), part_name("a.exr", 3, 3)});
    expect_result(counts, 78, "E-PART-MIX");
    EXPECT_THAT(counts.err, HasSubstr("--part: of 2 and of 3"));
}

TEST_F(Parts, TornFilesAreRefused) {
    part("a.exr", 1, 1);
    const std::string name = part_name("a.exr", 1, 1);
    const std::string whole = read_text(folder_ / name);
    folder_.write(name, whole.substr(0, whole.size() / 2));
    expect_result(run({"merge", name}), 74, "E-PART-DAMAGED");
    expect_result(run({"merge", "absent.film"}), 74, "E-PART-DAMAGED");
}

TEST_F(Parts, AutoAsksTheLauncher) {
    const std::vector<std::pair<Texts, std::string>> launchers = {
        {{"SLURM_PROCID=1", "SLURM_NTASKS=4"}, "2-of-4"},
        {{"SLURM_ARRAY_TASK_ID=5", "SLURM_ARRAY_TASK_COUNT=3", "SLURM_ARRAY_TASK_MIN=5"}, "1-of-3"},
        {{"OMPI_COMM_WORLD_RANK=2", "OMPI_COMM_WORLD_SIZE=3"}, "3-of-3"},
        {{"PMI_RANK=0", "PMI_SIZE=2"}, "1-of-2"}};
    for (const auto& [variables, name] : launchers) {
        ProgramSetup program =
            setup(small_render("box.gltf", {"-o", "a.exr", "--part", "auto"}), folder_);
        program.environment.insert(program.environment.end(), variables.begin(), variables.end());
        expect_result(run_program_with(program), 0, "OK");
        EXPECT_TRUE(std::filesystem::exists(folder_ / ("a.exr." + name + ".film"))) << name;
    }
    expect_result(render("box.gltf", {"--part", "auto"}), 64, "E-USAGE-CONFLICT");
}

TEST_F(Parts, WrongOptionsAreRefused) {
    for (const std::string text : {"0/2", "3/2"})
        expect_result(render("box.gltf", {"--part", text}), 64, "E-USAGE-RANGE");
    for (const std::string text : {"2", "x/2"})
        expect_result(render("box.gltf", {"--part", text}), 64, "E-USAGE-NUMBER");
    const std::vector<Texts> conflicts = {
        {"--part-by", "tiles"},
        {"--part", "1/2", "--part-by", "frames"},
        {"--part", "1/2", "--noise-target", "0.1"},
        {"--part", "1/2", "-o", "-"},
        {"--part", "1/2", "--part-by", "tiles", "--frames", "1-2", "-o", "a.#.exr"}};
    for (const Texts& options : conflicts)
        expect_result(render("box.gltf", options), 64, "E-USAGE-CONFLICT");
}

TEST_F(Parts, OfASequenceAreFrames) {
    const Texts frames = {"--frames", "1-3"};
    Texts whole = frames;
    whole.insert(whole.end(), {"-o", "whole.#.exr"});
    expect_result(render("box.gltf", whole), 0, "OK");
    for (const std::string part : {"1/2", "2/2"}) {
        Texts own = frames;
        own.insert(own.end(), {"-o", "a.#.exr", "--part", part});
        expect_result(render("box.gltf", own), 0, "OK");
        EXPECT_EQ(std::filesystem::exists(folder_ / "a.2.exr"), part == "2/2");
    }
    for (const std::string number : {"1", "2", "3"})
        expect_same_bits("a." + number + ".exr", "whole." + number + ".exr");
}

}  // namespace
}  // namespace obscura
