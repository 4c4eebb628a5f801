// tests/base/parallel_test.cpp - loops use as many threads as their own thread may use.
// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <filesystem>
#include <iterator>
#include <thread>

namespace obscura {
namespace {

size_t allowed() {
    return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

TEST(ThreadArena, LoopsUseItsThreadsAndTheProcessStaysAsItWas) {
    const size_t before = allowed();
    for (const int threads : {1, 2, 5}) {
        const ThreadArena arena(threads);
        EXPECT_EQ(arena.threads(), threads);
        EXPECT_EQ(max_thread_index(), static_cast<size_t>(threads));
        EXPECT_EQ(allowed(), before);
        std::atomic<size_t> sum = 0;
        std::atomic<bool> in_range = true;
        parallel_for(1000, [&](size_t i) {
            sum += i;
            if (thread_index() >= static_cast<size_t>(threads)) in_range = false;
            parallel_for(2, [&](size_t j) { sum += j; });  // a loop in a loop stays there
        });
        EXPECT_EQ(sum, 1000U * 999 / 2 + 1000);
        EXPECT_TRUE(in_range);
    }
}

TEST(ThreadArena, TheLatestCountsAndOtherThreadsHaveTheirOwn) {
    const ThreadArena outer(3);
    {
        const ThreadArena inner(1);
        EXPECT_EQ(max_thread_index(), 1U);
        std::thread([] {
            const ThreadArena other(4);
            EXPECT_EQ(max_thread_index(), 4U);
        }).join();
        EXPECT_EQ(max_thread_index(), 1U);
    }
    EXPECT_EQ(max_thread_index(), 3U);
}

TEST(ThreadLimit, AllowsTheProcessMoreThreadsThanCores) {
    const ThreadLimit limit(64);
    EXPECT_EQ(allowed(), 64U);
    EXPECT_EQ(max_thread_index(), 64U);
}

TEST(ThreadLimit, ItsThreadsAreStartedAhead) {
    const ThreadLimit limit(9);
    start_threads();
    const std::filesystem::directory_iterator tasks("/proc/self/task");
    EXPECT_GE(std::distance(begin(tasks), end(tasks)), 9);
}

}  // namespace
}  // namespace obscura
