// tests/base/priority_test.cpp - a process that gives way to others.
// SPDX-License-Identifier: Apache-2.0
#include "base/priority.h"

#include <gtest/gtest.h>

#include <sched.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace obscura {
namespace {

int nice_now() {
    return getpriority(PRIO_PROCESS, 0);
}

TEST(Priority, IsLowForThisThreadAndThoseThatItStarts) {
    const pid_t child = fork();
    if (child == 0) {
        const int before = nice_now();
        give_way_to_others();
        int of_thread = 0;
        std::thread([&] { of_thread = nice_now(); }).join();
        const bool is_low = of_thread >= 10 && nice_now() == of_thread && of_thread >= before;
        _exit(is_low && sched_getscheduler(0) == SCHED_BATCH ? 0 : 1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace obscura
