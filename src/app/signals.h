// app/signals.h - signals that ask for a stop or a checkpoint, and the true end by one.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

namespace obscura::app {

/// Ignores SIGPIPE, so that a closed standard output does not end the program.
void ignore_broken_pipes();

/// While it lives, the first SIGINT or SIGTERM sets a flag instead of ending the process. A second
/// SIGINT ends it at once; further SIGTERMs are ignored.
///
/// One that is made while another lives shares its signals: none is lost between the renderings of
/// a command. Its kind counts for nothing then.
class StopOnSignal {
public:
    enum class Kind {
        stops,    ///< SIGINT and SIGTERM
        farm_too  ///< SIGUSR1 stops, too, and SIGHUP asks for a checkpoint
    };
    explicit StopOnSignal(Kind kind = Kind::stops);
    ~StopOnSignal();
    StopOnSignal(const StopOnSignal&) = delete;
    StopOnSignal& operator=(const StopOnSignal&) = delete;

    const std::atomic<bool>& flag() const;

    /// Sets the flag as a signal would, and clears it unless there was a signal.
    void stop();
    void clear_unless_signal();

    /// True once after each SIGHUP.
    bool take_save_request();

private:
    Kind kind_;
    bool is_first_;
};

/// The signal that came since the first of the living, or the latest, was made; 0: none.
int received_stop_signal();

/// Restores the signal's default handling and sends it to this process again, so that the shell
/// and the farm see the true cause. Comes back only if the signal is blocked.
void end_by_signal(int signal);

}  // namespace obscura::app
