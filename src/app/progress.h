// app/progress.h - progress: a bar for people, lines for render farms.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/log.h"
#include "session/render_request.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace obscura::app {

/// Decides when a `Progress:` line is due: at once, then at most once a second when the percentage
/// has risen, and at least every 30 seconds. Time is any clock in seconds that does not go back.
class ProgressPacer {
public:
    /// The percentage to print now, if one is due. 100 is kept for finish().
    std::optional<int> due(double now_s, double fraction);

private:
    std::optional<double> last_time_s_;
    int last_percent_ = -1;
};

/// One line of at most `columns` characters: percentage, bar and the time left.
std::string progress_bar(double fraction, double elapsed_s, int columns);

/// The lines that tell a percentage: `Progress: 42%`, which people and Deadline read, and after it
/// the one of another farm manager.
/// Source  Open Job Description, "How Jobs Are Run", 2023-09: openjd_progress; Pixar, Tractor, "Job
///         Scripting": ALF_PROGRESS
std::string progress_lines(FarmManager farm, int percent);

/// Shows progress from a thread of its own for as long as it lives: a bar on standard error when
/// that is a terminal, else `Progress: 42%` lines; nothing when quiet. A farm manager gets its
/// lines in any case.
class Progress {
public:
    /// lines: where those go: standard output, unless an image goes there.
    explicit Progress(Verbosity verbosity,
                      std::FILE* lines = stdout,
                      FarmManager farm = FarmManager::none);
    /// Stops without a last line: the work did not end well.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// The measured work starts now: the bar appears, and its time left counts from here.
    void begin();
    /// fraction: finished part in [0, 1]; from any thread, never goes back.
    void update(double fraction);
    /// The work is done: shows 100 % and stops.
    void finish();

private:
    enum class Style { none, bar, lines };
    void run();
    void show_now();
    void print_lines(int percent);
    double seconds() const;
    void stop();

    Style style_;
    std::FILE* lines_;
    FarmManager farm_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::atomic<double> begin_s_{-1.0};  ///< since start_; negative before begin()
    std::atomic<double> fraction_{0.0};
    ProgressPacer pacer_;  ///< used by one thread at a time
    std::mutex mutex_;
    std::condition_variable wake_;
    bool stopping_ = false;
    std::thread thread_;
};

}  // namespace obscura::app
