// tests/cli/memory_test.cpp - --max-memory: bombs end at once, and what does not fit ends with 33.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "cli/cli.h"
#include <fstream>
#include <sys/resource.h>

namespace obscura {
namespace {

using testing::HasSubstr;

class MaxMemory : public Cli {
protected:
    /// A file of so many zeros, which take no room on the disk.
    void write_sparse(const std::string& name, uint64_t bytes) const {
        folder_.write(name, "");
        std::filesystem::resize_file(folder_ / name, bytes);
    }
    ProgramRun run_with_addresses(uint64_t mebibytes, std::vector<std::string> arguments) const {
        ProgramSetup program = setup(std::move(arguments), folder_);
        program.before_start = [bytes = mebibytes << 20] {
            const rlimit limit = {bytes, bytes};
            setrlimit(RLIMIT_AS, &limit);
        };
        return run_program_with(program);
    }
};

TEST_F(MaxMemory, WhatFitsIsRendered) {
    expect_result(render("box.gltf", {"-o", "a.exr", "--max-memory", "1G"}), 0, "OK");
    expect_result(render("box.gltf", {"-o", "a.exr", "--max-memory", "90%"}), 0, "OK");
    expect_result(render("box.gltf", {"--max-memory", "much"}), 64, "E-USAGE-NUMBER");
}

TEST_F(MaxMemory, TheProgramItselfCounts) {
    const ProgramRun got = render("box.gltf", {"-o", "a.exr", "--max-memory", "100M"});
    expect_result(got, 33, "E-MEM");
    EXPECT_THAT(got.err, HasSubstr("--max-memory"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.exr"));
}

TEST_F(MaxMemory, AFilmIsNamed) {
    const ProgramRun got =
        render("box.gltf", {"-o", "a.exr", "--max-memory", "300M", "--size", "8000x6000"});
    expect_result(got, 33, "E-MEM");
    EXPECT_THAT(got.err, HasSubstr("the film would take"));
    EXPECT_THAT(got.err, HasSubstr("300 MiB, which is --max-memory"));
}

TEST_F(MaxMemory, ASparseBuffer) {
    write_sparse("five.bin", uint64_t{5} << 30);
    folder_.write(
        "five.gltf",
        R"({"asset":{"version":"2.0"},"buffers":[{"uri":"five.bin","byteLength":5368709120}]})");
    const ProgramRun got = render("five.gltf", {"-o", "a.exr", "--max-memory", "2G"});
    expect_result(got, 33, "E-MEM");
    EXPECT_THAT(got.err, HasSubstr("buffers would take 5.0 GiB"));
}

TEST_F(MaxMemory, ALongText) {
    write_sparse("long.gltf", uint64_t{1} << 30);
    const ProgramRun got = render("long.gltf", {"-o", "a.exr", "--max-memory", "1G"});
    expect_result(got, 33, "E-MEM");
    EXPECT_THAT(got.err, HasSubstr("the scene's text would take 1.0 GiB"));
}

TEST_F(MaxMemory, ACheckpointStays) {
    write_sparse("a.exr.checkpoint", uint64_t{5} << 30);
    const ProgramRun got =
        render("box.gltf", {"-o", "a.exr", "--checkpoint", "--max-memory", "2G"});
    expect_result(got, 33, "E-MEM");
    EXPECT_THAT(got.err, HasSubstr("a.exr.checkpoint"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "a.exr.checkpoint"));
}

#if !defined(__SANITIZE_ADDRESS__)
/// OpenImageIO's libraries, and TBB with many threads, end the process or wait for good where a
/// thread has no stack.
TEST_F(MaxMemory, FewAddressesEndWith33) {
    for (const auto& [output, threads] : {std::pair{"a.jpg", "2"}, std::pair{"a.exr", "64"}}) {
        size_t refused = 0;
        bool rendered = false;
        for (uint64_t mebibytes = 290; mebibytes <= 1500 && !rendered; mebibytes += 20) {
            SCOPED_TRACE(mebibytes);
            if (run_with_addresses(mebibytes, {"--version"}).code != 0) continue;
            const ProgramRun got = run_with_addresses(
                mebibytes, small_render("box.gltf", {"-o", output, "--threads", threads}));
            rendered = got.code == 0;
            if (!rendered) expect_result(got, 33, "E-MEM");
            if (!rendered) ++refused;
            EXPECT_EQ(std::filesystem::exists(folder_ / output), rendered);
        }
        EXPECT_TRUE(rendered) << output;
        EXPECT_GT(refused, 2U) << output;
    }
    expect_result(run_with_addresses(400, small_render("box.gltf", {"-o", "a.avif"})), 33, "E-MEM");
}
#endif

}  // namespace
}  // namespace obscura
