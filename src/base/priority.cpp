// base/priority.cpp - lets other programs go first.
// SPDX-License-Identifier: Apache-2.0
#include "base/priority.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <sched.h>
#include <sys/resource.h>
#include <system_error>

namespace obscura {

namespace {

/// In      thread: its number; 0: the calling one
void lower(int thread) {
    constexpr int low = 10;
    const auto who = static_cast<id_t>(thread);
    errno = 0;
    const int now = ::getpriority(PRIO_PROCESS, who);
    if (errno == 0) ::setpriority(PRIO_PROCESS, who, std::max(now, low));
#if defined(SCHED_BATCH)
    const sched_param none = {};
    if (::sched_getscheduler(thread) == SCHED_OTHER)
        ::sched_setscheduler(thread, SCHED_BATCH, &none);
#endif
}

}  // namespace

void give_way_to_others() {
    lower(0);
    std::error_code none;  // not on Linux
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task", none))
        lower(std::atoi(task.path().filename().c_str()));
}

}  // namespace obscura
