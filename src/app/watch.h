// app/watch.h - a thread beside a rendering: signals, the time limit, checkpoints and snapshots.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/signals.h"
#include "base/log.h"

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace obscura::app {

/// Decides when something is due that is done again and again. Time is any clock in seconds.
class Repetition {
public:
    /// In      first_s, interval_s: from `begin` to the first time, and between times
    ///         max_share: of all time, that doing it may take; intervals grow until it fits
    Repetition(double first_s, double interval_s, double max_share);

    void begin(double now_s) { next_s_ = now_s + first_s_; }
    bool is_due(double now_s) const { return now_s >= next_s_; }
    void done(double begin_s, double end_s);

private:
    double first_s_, interval_s_, max_share_;
    double next_s_ = 0;
};

/// When what is done beside a rendering.
struct WatchTimes {
    std::optional<double> time_limit_s;  ///< since the Watch was made
    std::optional<double> checkpoint_interval_s, snapshot_interval_s;
};

/// Checkpoints are due after this time, or their interval if that is shorter.
double first_checkpoint_s(double interval_s);

/// While it lives, signals and the time limit stop the command in an orderly way. Where nothing can
/// be lost, in loading, building, reading a checkpoint, denoising, they end it at once, with its
/// result line; while rendering and writing they set a flag.
class Watch {
public:
    /// In      where: the scene, for messages
    Watch(std::string where, const Log& log, const WatchTimes& times);
    ~Watch();
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;

    /// What the thread does while an image is rendered; an empty one: nothing.
    struct Tasks {
        std::function<void()> save, snapshot;
    };
    void begin_rendering(Tasks tasks);
    /// Before it: a checkpoint is read. The time limit waits, as there will be a picture.
    void begin_reading();
    /// Waits until no task is running; from now on none will. False: a signal came, and the caller
    /// is to end the command.
    [[nodiscard]] bool begin_finishing();
    /// Files are being written, whole or not at all: not to be cut short.
    void begin_writing();
    /// The next image is loaded and built.
    void begin_preparing();
    /// Files are being written while something else goes on: as long as they are, nothing ends at
    /// once.
    void begin_writing_beside();
    void end_writing_beside();
    /// The command ends, and says so itself.
    void end();
    /// Begins something, and takes from it what is to be done first when a signal or the time limit
    /// ends the program at once; an empty one: nothing. No such end comes in between. Both wait
    /// until the program has ended, if it does.
    using LastTask = std::function<void()>;
    void begin_undoable(const std::function<LastTask()>& begin);
    void forget_last_task();

    const std::atomic<bool>& stop() const { return signals_.flag(); }
    /// True when the time limit has stopped the rendering.
    bool is_time_up() const;

private:
    enum class Phase { preparing, reading, rendering, finishing, writing, ending };

    void run();
    void look_after();
    void end_now(bool is_late);
    void do_if_due(Repetition& repetition, const std::function<void()>& task, bool at_once);
    double seconds() const;

    const std::string where_;
    const Log& log_;
    const WatchTimes times_;
    StopOnSignal signals_;
    const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::mutex mutex_;  ///< of what follows; held while a task runs
    std::condition_variable wake_;
    Phase phase_ = Phase::preparing;
    Tasks tasks_;
    std::function<void()> last_task_;
    Repetition saves_, snapshots_;
    int writing_beside_ = 0;
    bool ending_ = false;
    std::atomic<bool> time_is_up_ = false;
    std::thread thread_;
};

}  // namespace obscura::app
