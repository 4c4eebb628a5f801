// base/parallel.h - parallel loops; the only access to oneTBB.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace obscura {

/// While it exists, loops that its own thread starts run on this many threads. Other threads and
/// the process are not affected. The latest one of a thread counts.
class ThreadArena {
public:
    /// threads: 1 or more; 0 takes every core that the process may use, by affinity and cpu_quota.
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

/// A ThreadArena that also sets the process's thread limit, above or below the number of cores.
/// Only for programs that own their process.
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

/// Starts the threads that loops of the calling thread run on, which start when they are needed,
/// otherwise.
void start_threads();

/// Calls `body` in the arena of the calling thread, for libraries that have loops of their own.
void run_in_arena(const std::function<void()>& body);

/// Calls `body(i)` for every i in [0, count), on all threads, in no particular order.
/// An exception from a body ends the loop and reaches the caller.
void parallel_for(size_t count, const std::function<void(size_t)>& body);

/// Calls `body(begin, end)` for ranges of at most `grain` that together cover [0, count).
void parallel_ranges(size_t count, size_t grain, const std::function<void(size_t, size_t)>& body);

/// Index of the calling thread, below max_thread_index(); stable inside one body.
size_t thread_index();
size_t max_thread_index();

/// Flushes denormal numbers to zero while this exists (x86: FTZ and DAZ; arm64: FZ).
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
