// app/progress.cpp - progress: a bar for people, lines for render farms.
// SPDX-License-Identifier: Apache-2.0
#include "app/progress.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sys/ioctl.h>
#include <unistd.h>

namespace obscura::app {

namespace {

constexpr double min_gap_s = 1.0;
constexpr double max_gap_s = 30.0;
constexpr std::chrono::milliseconds bar_period{200};
constexpr std::chrono::milliseconds line_period{250};

int terminal_columns() {
    winsize size = {};
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

/// "1:02:03" or "2:03".
std::string clock_text(double seconds) {
    const auto whole = static_cast<long long>(std::min(seconds, 3.6e8) + 0.5);
    char text[32];
    if (whole >= 3600) {
        std::snprintf(
            text, sizeof text, "%lld:%02lld:%02lld", whole / 3600, whole / 60 % 60, whole % 60);
    } else {
        std::snprintf(text, sizeof text, "%lld:%02lld", whole / 60, whole % 60);
    }
    return text;
}

}  // namespace

std::optional<int> ProgressPacer::due(double now_s, double fraction) {
    const int percent = std::clamp(static_cast<int>(100 * fraction), 0, 99);
    if (last_time_s_) {
        const double gap = now_s - *last_time_s_;
        const bool rose = percent > last_percent_;
        if (gap < (rose ? min_gap_s : max_gap_s)) return std::nullopt;
    }
    last_time_s_ = now_s;
    last_percent_ = std::max(percent, last_percent_);
    return last_percent_;
}

std::string progress_bar(double fraction, double elapsed_s, int columns) {
    char percent[8];
    std::snprintf(percent, sizeof percent, "%3d%%", static_cast<int>(100 * fraction));
    const std::string left = fraction > 0.01
                                 ? clock_text(elapsed_s * (1 - fraction) / fraction) + " left"
                                 : "estimating";
    const int fixed = 4 + 2 + 2 + static_cast<int>(left.size());
    const int cells = std::min(columns - fixed - 1, 60);
    if (cells < 5)
        return (std::string(percent) + ' ' + left).substr(0, static_cast<size_t>(columns));
    const auto filled = static_cast<size_t>(std::clamp(fraction, 0.0, 1.0) * cells);
    return std::string(percent) + " [" + std::string(filled, '#') +
           std::string(static_cast<size_t>(cells) - filled, '.') + "] " + left;
}

std::string progress_lines(FarmManager farm, int percent) {
    const std::string number = std::to_string(percent);
    const std::string line = "Progress: " + number + "%\n";
    if (farm == FarmManager::alfred) return line + "ALF_PROGRESS " + number + "%\n";
    if (farm == FarmManager::openjd) return line + "openjd_progress: " + number + "\n";
    return line;
}

Progress::Progress(Verbosity verbosity, std::FILE* lines, FarmManager farm)
    : style_(Style::none), lines_(lines), farm_(farm) {
    const bool has_reader = farm != FarmManager::none;
    if (verbosity == Verbosity::quiet && !has_reader) return;
    style_ = has_reader || isatty(STDERR_FILENO) == 0 ? Style::lines : Style::bar;
    show_now();
    thread_ = std::thread([this] { run(); });
}

Progress::~Progress() {
    stop();
    if (style_ == Style::bar) std::fputs("\r\x1b[K", stderr);
}

void Progress::begin() {
    begin_s_.store(seconds());
}

void Progress::update(double fraction) {
    double known = fraction_.load(std::memory_order_relaxed);
    while (fraction > known && !fraction_.compare_exchange_weak(known, fraction)) {
    }
}

void Progress::finish() {
    stop();
    if (style_ == Style::lines) print_lines(100);
    if (style_ == Style::bar) std::fputs("\r\x1b[K", stderr);
    style_ = Style::none;
}

void Progress::run() {
    std::unique_lock lock(mutex_);
    const auto period = style_ == Style::bar ? bar_period : line_period;
    while (!wake_.wait_for(lock, period, [this] { return stopping_; }))
        show_now();
}

double Progress::seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Progress::show_now() {
    const double fraction = fraction_.load(std::memory_order_relaxed);
    const double begin_s = begin_s_.load();
    if (style_ == Style::lines) {
        if (const std::optional<int> percent = pacer_.due(seconds(), fraction))
            print_lines(*percent);
    } else if (begin_s >= 0) {  // before that, warnings of loading would mix with the bar
        const std::string bar = progress_bar(fraction, seconds() - begin_s, terminal_columns());
        std::fprintf(stderr, "\r\x1b[K%s", bar.c_str());
        std::fflush(stderr);
    }
}

void Progress::print_lines(int percent) {
    std::fputs(progress_lines(farm_, percent).c_str(), lines_);
    std::fflush(lines_);
}

void Progress::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    wake_.notify_all();
    if (thread_.joinable()) thread_.join();
}

}  // namespace obscura::app
