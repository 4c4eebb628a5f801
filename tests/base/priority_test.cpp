// tests/base/priority_test.cpp - a process that gives way to others.
// SPDX-License-Identifier: Apache-2.0
#include "base/priority.h"

#include <gtest/gtest.h>

#include <sched.h>
#include <sys/resource.h>
#include <thread>
#include <unistd.h>

namespace obscura {
namespace {

int nice_now() {
    return getpriority(PRIO_PROCESS, 0);
}

[[noreturn]] void give_way_and_exit() {
    const int before = nice_now();
    give_way_to_others();
    int of_thread = 0;
    std::thread([&] { of_thread = nice_now(); }).join();
    const bool is_low = of_thread >= 10 && nice_now() == of_thread && of_thread >= before;
    _exit(is_low && sched_getscheduler(0) == SCHED_BATCH ? 0 : 1);
}

TEST(Priority, IsLowForThisThreadAndThoseThatItStarts) {
    // A program that starts anew: a fork alone may take over a lock that a thread held.
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(give_way_and_exit(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace obscura
