// base/parallel.h - loops over all cores; the only door to the task scheduler.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace obscura {

/// Limits the number of threads for as long as it lives. One per process, made by the command.
class ThreadLimit {
public:
    /// threads: 1 or more; 0 takes every core that the process may use.
    explicit ThreadLimit(int threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

    int threads() const { return threads_; }

private:
    int threads_;
    void* control_;
};

/// Calls `body(i)` for every i in [0, count), on all threads, in no particular order.
/// An exception from a body ends the loop and reaches the caller.
void parallel_for(size_t count, const std::function<void(size_t)>& body);

/// Calls `body(begin, end)` for ranges of at most `grain` that together cover [0, count).
void parallel_ranges(size_t count, size_t grain, const std::function<void(size_t, size_t)>& body);

/// Index of the calling thread, below max_thread_index(); stable inside one body.
size_t thread_index();
size_t max_thread_index();

/// Denormal numbers count as zero while this lives (x86: FTZ and DAZ; arm64: FZ).
class FlushDenormals {
public:
    FlushDenormals();
    ~FlushDenormals();
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;

private:
    unsigned long long saved_;
};

}  // namespace obscura
