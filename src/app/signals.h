// app/signals.h - SIGINT and SIGTERM: an orderly stop while rendering, an immediate end before.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

namespace obscura::app {

/// Ignores SIGPIPE, so that a closed standard output does not end the program.
void ignore_broken_pipes();

/// While it lives, the first SIGINT or SIGTERM sets a flag instead of ending the process. A second
/// SIGINT ends it at once; further SIGTERMs are ignored. At most one lives at a time.
class StopOnSignal {
public:
    StopOnSignal();
    ~StopOnSignal();
    StopOnSignal(const StopOnSignal&) = delete;
    StopOnSignal& operator=(const StopOnSignal&) = delete;

    const std::atomic<bool>& flag() const;
};

/// The signal that stopped the latest StopOnSignal, 0 if none did.
int received_stop_signal();

/// Restores the signal's default handling and sends it to this process again, so that the shell
/// and the farm see the true cause. Comes back only if the signal is blocked.
void end_by_signal(int signal);

}  // namespace obscura::app
