// tests/bench/machine_test.cpp - what the system tells of a machine; doubtful times.
// SPDX-License-Identifier: Apache-2.0
#include "bench/machine.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <gmock/gmock.h>

namespace obscura::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Machine, IsDescribed) {
    const Machine machine = describe_machine();
    EXPECT_FALSE(machine.cpu.empty());
    EXPECT_GE(machine.cores, 1);
    EXPECT_GE(machine.load, 0) << "Linux tells it";
    const std::filesystem::path system = "/sys/devices/system";
    if (std::filesystem::exists(system / "cpu/cpu0/cache/index0/level")) {
        EXPECT_GE(machine.caches.size(), 1U);
    }
    if (std::filesystem::exists(system / "node/node0")) {
        EXPECT_GE(machine.numa_nodes, 1);
    }
    if (machine.clock_mhz != 0) {  // emulators tell none
        EXPECT_THAT(machine.clock_mhz, testing::AllOf(testing::Gt(100), testing::Lt(20000)));
    }
    for (const CpuCache& cache : machine.caches) {
        EXPECT_THAT(cache.level, testing::AllOf(testing::Ge(1), testing::Le(4)));
        EXPECT_FALSE(cache.type.empty());
        EXPECT_FALSE(cache.size.empty());
    }
}

TEST(Machine, IsDoubtfulWhenOthersWorkOnIt) {
    Machine machine;
    machine.cores = 8;
    machine.load = 0.4;
    EXPECT_TRUE(doubts_about(machine, {8, 4}).empty());
    machine.load = -1;
    EXPECT_TRUE(doubts_about(machine, {8}).empty()) << "not known";
    machine.load = 3.25;
    EXPECT_THAT(doubts_about(machine, {8}), ElementsAre(HasSubstr("3.2 threads")));
}

TEST(Machine, IsDoubtfulWhenThreadsShareCores) {
    Machine machine;
    machine.cores = 8;
    EXPECT_THAT(doubts_about(machine, {4, 16}), ElementsAre(HasSubstr("16 threads share 8 cores")));
}

}  // namespace
}  // namespace obscura::bench
