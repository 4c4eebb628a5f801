// base/parallel.h - loops over all cores; the only door to the task scheduler.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace obscura {

/// For as long as it lives, loops that its own thread begins run on so many threads, and others as
/// before: nothing of the process is changed. The latest of a thread counts.
class ThreadArena {
public:
    /// threads: 1 or more; 0 takes every core that the process may use.
    explicit ThreadArena(int threads);
    ~ThreadArena();
    ThreadArena(const ThreadArena&) = delete;
    ThreadArena& operator=(const ThreadArena&) = delete;

    int threads() const { return threads_; }

private:
    int threads_;
    void* arena_;
    void* before_;
};

/// A ThreadArena that also allows the process more threads than it has cores, or fewer. For a
/// program that owns its process.
class ThreadLimit {
public:
    explicit ThreadLimit(int threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

    int threads() const { return arena_.threads(); }

private:
    void* control_;
    ThreadArena arena_;
};

/// Calls `body` where loops of the calling thread run, for a library that has loops of its own.
void run_in_arena(const std::function<void()>& body);

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
