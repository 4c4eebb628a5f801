// base/priority.h - lets other programs go first.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace obscura {

/// All threads of the process, and those that they start from now on, give way to other programs:
/// nice 10, or what it was if that is more, and on Linux the scheduler's class for batch jobs
/// (SCHED_BATCH), which waits longer and is interrupted less. To be called before threads are
/// started but by libraries.
///
/// Source  Linux, setpriority(2) (on Linux a nice value is of a thread), sched(7)
void give_way_to_others();

}  // namespace obscura
