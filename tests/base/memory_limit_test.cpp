// tests/base/memory_limit_test.cpp - limits of control groups, the machine and the shell.
// SPDX-License-Identifier: Apache-2.0
#include "base/memory_limit.h"

#include <gtest/gtest.h>

#include "support/temp_folder.h"
#include <sys/resource.h>

namespace obscura {
namespace {

/// A folder that stands for the root of a machine.
struct LimitedMachine {
    TempFolder root;

    void write(const std::string& file, const std::string& text) const {
        std::filesystem::create_directories((root / file).parent_path());
        root.write(file, text);
    }
    uint64_t bytes() const { return memory_bound(root.path()).bytes; }
};

/// The tests themselves may run under `ulimit -v`.
uint64_t at_most_address_space(uint64_t bytes) {
    rlimit limit = {};
    getrlimit(RLIMIT_AS, &limit);
    return limit.rlim_cur == RLIM_INFINITY ? bytes : std::min<uint64_t>(bytes, limit.rlim_cur);
}

TEST(MemoryLimit, NothingIsKnownWithoutFiles) {
    const LimitedMachine machine;
    EXPECT_EQ(machine.bytes(), at_most_address_space(UINT64_MAX));
}

TEST(MemoryLimit, AddressesThatAreTakenAreNotLeft) {
    const uint64_t limit = at_most_address_space(UINT64_MAX);
    const uint64_t left = address_space_left();
    if (limit == UINT64_MAX) {
        EXPECT_EQ(left, UINT64_MAX);
    } else {
        EXPECT_LT(left, limit);
    }
}

TEST(MemoryLimit, TooFewAddressesAreRefused) {
    EXPECT_TRUE(check_address_space(UINT64_MAX, uint64_t{160} << 20, "rendering"));
    EXPECT_TRUE(check_address_space(uint64_t{160} << 20, uint64_t{160} << 20, "rendering"));
    const Result<void> refused =
        check_address_space((uint64_t{160} << 20) - 1, uint64_t{160} << 20, "rendering");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ExitCode::out_of_memory);
    EXPECT_NE(refused.error().message.find("rendering needs 160 MiB"), std::string::npos);
}

TEST(MemoryLimit, TheLeastOfMachineAndGroupsCounts) {
    const LimitedMachine machine;
    machine.write("proc/meminfo", "MemTotal:       1024 kB\nMemFree:  12 kB\n");
    EXPECT_EQ(machine.bytes(), 1U << 20);
    machine.write("proc/self/cgroup", "0::/pods/job\n");
    machine.write("sys/fs/cgroup/memory.max", "max\n");
    EXPECT_EQ(machine.bytes(), 1U << 20);
    machine.write("sys/fs/cgroup/pods/memory.max", "70000\n");
    machine.write("sys/fs/cgroup/pods/job/memory.max", "80000\n");
    const MemoryBound bound = memory_bound(machine.root.path());
    EXPECT_EQ(bound.bytes, 70000U);
    EXPECT_EQ(bound.source, "the control group's limit");
}

TEST(MemoryLimit, VersionOneCountsItsOwnController) {
    const LimitedMachine machine;
    machine.write("proc/self/cgroup", "5:cpu,cpuacct:/c\n4:memory:/jobs/one\n");
    machine.write("sys/fs/cgroup/cpu/c/memory.limit_in_bytes", "1\n");
    machine.write("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
    machine.write("sys/fs/cgroup/memory/jobs/one/memory.limit_in_bytes", "50000\n");
    EXPECT_EQ(machine.bytes(), 50000U);
}

TEST(MemoryLimit, OddFilesAreNoLimit) {
    const LimitedMachine machine;
    machine.write("proc/meminfo", "MemTotal: many kB\n");
    machine.write("proc/self/cgroup", "\n:\nnonsense\n0::/../up\n");
    machine.write("sys/fs/cgroup/memory.max", "\n");
    EXPECT_EQ(machine.bytes(), at_most_address_space(UINT64_MAX));
}

}  // namespace
}  // namespace obscura
