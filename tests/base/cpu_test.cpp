// tests/base/cpu_test.cpp - instruction sets build on each other, and /proc/cpuinfo agrees.
// SPDX-License-Identifier: Apache-2.0
#include "base/cpu.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>

namespace obscura {
namespace {

std::set<std::string> flags_of_the_system() {
    std::ifstream in("/proc/cpuinfo");
    std::set<std::string> flags;
    for (std::string line; std::getline(in, line);) {
        if (!line.starts_with("flags")) continue;
        std::istringstream words(line);
        for (std::string word; words >> word;)
            flags.insert(word);
        break;
    }
    return flags;
}

TEST(Cpu, WiderSetsHoldNarrowerOnes) {
    EXPECT_TRUE(!cpu_has_avx512() || cpu_has_avx2());
    EXPECT_TRUE(!cpu_has_avx2() || cpu_has_avx());
    EXPECT_TRUE(!cpu_has_avx() || cpu_has_sse42());
}

TEST(Cpu, AgreesWithTheSystem) {
    const std::set<std::string> flags = flags_of_the_system();
    if (flags.empty()) GTEST_SKIP() << "this system lists no flags";
    EXPECT_EQ(cpu_has_sse42(), flags.contains("sse4_2"));
    EXPECT_EQ(cpu_has_avx(), flags.contains("avx"));
    EXPECT_EQ(cpu_has_avx2(), flags.contains("avx2") && flags.contains("fma"));
    EXPECT_EQ(cpu_has_avx512(), flags.contains("avx512bw") && flags.contains("avx512vl"));
}

}  // namespace
}  // namespace obscura
