// base/parallel.cpp - parallel loops; the only access to oneTBB.
// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"

#include "base/cpu_quota.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <optional>
#include <thread>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace obscura {

namespace {

/// The arena of this thread's ThreadArena; null: the thread's current one.
thread_local tbb::task_arena* own_arena = nullptr;

/// As many as there are cores that the process may use, by affinity and by quota.
int default_threads() {
    const int cores = tbb::info::default_concurrency();
    static const std::optional<double> quota = cpu_quota();
    if (!quota || *quota >= cores) return cores;
    return std::max(static_cast<int>(std::ceil(*quota)), 1);
}

int threads_of(int threads) {
    return threads > 0 ? threads : default_threads();
}

template <typename Body>
void in_arena(const Body& body) {
    if (own_arena == nullptr) {
        body();
    } else {
        own_arena->execute(body);
    }
}

}  // namespace

ThreadArena::ThreadArena(int threads)
    : threads_(threads_of(threads)), arena_(new tbb::task_arena(threads_)), before_(own_arena) {
    own_arena = static_cast<tbb::task_arena*>(arena_);
}

ThreadArena::~ThreadArena() {
    own_arena = static_cast<tbb::task_arena*>(before_);
    delete static_cast<tbb::task_arena*>(arena_);
}

ThreadLimit::ThreadLimit(int threads)
    : control_(new tbb::global_control(tbb::global_control::max_allowed_parallelism,
                                       static_cast<size_t>(threads_of(threads)))),
      arena_(threads) {}

ThreadLimit::~ThreadLimit() {
    delete static_cast<tbb::global_control*>(control_);
}

void start_threads() {
    const size_t all = max_thread_index();
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(1);
    std::atomic<size_t> begun = 0;
    // Each thread waits for the others in its only round.
    parallel_for(all, [&](size_t) {
        ++begun;
        while (begun < all && std::chrono::steady_clock::now() < end)
            std::this_thread::yield();
    });
}

void run_in_arena(const std::function<void()>& body) {
    in_arena(body);
}

void parallel_for(size_t count, const std::function<void(size_t)>& body) {
    parallel_ranges(count, 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
            body(i);
    });
}

void parallel_ranges(size_t count, size_t grain, const std::function<void(size_t, size_t)>& body) {
    in_arena([&] {
        tbb::parallel_for(
            tbb::blocked_range<size_t>(0, count, std::max<size_t>(grain, 1)),
            [&](const tbb::blocked_range<size_t>& range) {
                const FlushDenormals flush;
                body(range.begin(), range.end());
            },
            tbb::simple_partitioner{});
    });
}

size_t thread_index() {
    const int index = tbb::this_task_arena::current_thread_index();
    return index < 0 ? 0 : static_cast<size_t>(index);
}

size_t max_thread_index() {
    return static_cast<size_t>(own_arena != nullptr ? own_arena->max_concurrency()
                                                    : tbb::this_task_arena::max_concurrency());
}

#if defined(__x86_64__)
FlushDenormals::FlushDenormals() : saved_(_mm_getcsr()) {
    _mm_setcsr(static_cast<unsigned>(saved_) | 0x8040U);
}
FlushDenormals::~FlushDenormals() {
    _mm_setcsr(static_cast<unsigned>(saved_));
}
#elif defined(__aarch64__)
FlushDenormals::FlushDenormals() : saved_(0) {
    __asm__ volatile("mrs %0, fpcr" : "=r"(saved_));
    __asm__ volatile("msr fpcr, %0" ::"r"(saved_ | (1ULL << 24)));
}
FlushDenormals::~FlushDenormals() {
    __asm__ volatile("msr fpcr, %0" ::"r"(saved_));
}
#endif

}  // namespace obscura
