// app/watch.cpp - a thread beside a rendering: signals, the time limit, checkpoints and snapshots.
// SPDX-License-Identifier: Apache-2.0
#include "app/watch.h"

#include "app/outcome.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace obscura::app {

namespace {

constexpr std::chrono::milliseconds poll_period{20};
constexpr double max_first_checkpoint_s = 30;
// Saving costs some of the cores' time, and mostly waiting for the disk.
constexpr double max_share_of_checkpoints = 0.02;
constexpr double max_share_of_snapshots = 0.2;
constexpr double never_s = 1e18;

}  // namespace

Repetition::Repetition(double first_s, double interval_s, double max_share)
    : first_s_(first_s), interval_s_(interval_s), max_share_(max_share) {}

void Repetition::done(double begin_s, double end_s) {
    next_s_ = end_s + std::max(interval_s_, (end_s - begin_s) * (1 / max_share_ - 1));
}

double first_checkpoint_s(double interval_s) {
    return std::min(interval_s, max_first_checkpoint_s);
}

Watch::Watch(std::string where, const Log& log, const WatchTimes& times)
    : where_(std::move(where)),
      log_(log),
      times_(times),
      signals_(StopOnSignal::Kind::farm_too),
      saves_(first_checkpoint_s(times.checkpoint_interval_s.value_or(never_s)),
             times.checkpoint_interval_s.value_or(never_s),
             max_share_of_checkpoints),
      snapshots_(times.snapshot_interval_s.value_or(never_s),
                 times.snapshot_interval_s.value_or(never_s),
                 max_share_of_snapshots) {
    // Renderings may be shorter than a poll's period: a signal that came before is seen at once.
    if (received_stop_signal() != 0) end_now(false);
    thread_ = std::thread([this] { run(); });
}

Watch::~Watch() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    wake_.notify_all();
    thread_.join();
}

void Watch::begin_reading() {
    const std::lock_guard lock(mutex_);
    phase_ = Phase::reading;
}

void Watch::begin_rendering(Tasks tasks) {
    const std::lock_guard lock(mutex_);
    tasks_ = std::move(tasks);
    saves_.begin(seconds());
    snapshots_.begin(seconds());
    phase_ = Phase::rendering;
}

bool Watch::begin_finishing() {
    const std::lock_guard lock(mutex_);
    tasks_ = {};
    if (time_is_up_) signals_.clear_unless_signal();  // the image so far is written
    phase_ = received_stop_signal() != 0 ? Phase::ending : Phase::finishing;
    return phase_ == Phase::finishing;
}

void Watch::begin_writing() {
    const std::lock_guard lock(mutex_);
    phase_ = Phase::writing;
}

void Watch::begin_preparing() {
    const std::lock_guard lock(mutex_);
    phase_ = Phase::preparing;
}

void Watch::begin_writing_beside() {
    const std::lock_guard lock(mutex_);
    ++writing_beside_;
}

void Watch::end_writing_beside() {
    const std::lock_guard lock(mutex_);
    --writing_beside_;
}

void Watch::end() {
    const std::lock_guard lock(mutex_);
    phase_ = Phase::ending;
}

void Watch::begin_undoable(const std::function<LastTask()>& begin) {
    const std::lock_guard lock(mutex_);
    last_task_ = begin();
}

void Watch::forget_last_task() {
    const std::lock_guard lock(mutex_);
    last_task_ = {};
}

bool Watch::is_time_up() const {
    return time_is_up_;
}

void Watch::run() {
    std::unique_lock lock(mutex_);
    while (!wake_.wait_for(lock, poll_period, [this] { return ending_; }))
        look_after();
}

void Watch::look_after() {
    const bool is_signalled = received_stop_signal() != 0;
    const bool is_late = times_.time_limit_s && seconds() >= *times_.time_limit_s;
    const bool may_end_now =
        phase_ == Phase::preparing || phase_ == Phase::reading || phase_ == Phase::finishing;
    if (may_end_now) {
        const bool ends = is_signalled || (is_late && phase_ == Phase::preparing);
        if (ends && writing_beside_ == 0) end_now(!is_signalled);
        return;
    }
    if (phase_ != Phase::rendering) return;
    if (is_late && !is_signalled) time_is_up_ = true;
    if (is_late) signals_.stop();
    if (stop()) return;
    do_if_due(saves_, tasks_.save, signals_.take_save_request());
    do_if_due(snapshots_, tasks_.snapshot, false);
}

void Watch::end_now(bool is_late) {
    if (last_task_) last_task_();
    if (is_late) {
        report_failure({ExitCode::stopped_early,
                        "E-TIME-LIMIT",
                        where_,
                        "the time limit is over before there is anything of a picture"},
                       log_);
    } else {
        report_stop(received_stop_signal(), where_, "", log_);
    }
    std::fflush(nullptr);
    // Other threads are at work: nothing may be torn down below them.
    std::_Exit(static_cast<int>(ExitCode::stopped_early));
}

void Watch::do_if_due(Repetition& repetition, const std::function<void()>& task, bool at_once) {
    const double begin = seconds();
    if (!task || !(at_once || repetition.is_due(begin))) return;
    task();
    repetition.done(begin, seconds());
}

double Watch::seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

}  // namespace obscura::app
