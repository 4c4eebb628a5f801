// base/stopwatch.h - measures seconds, and adds them to sums.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace obscura {

/// Runs from its construction, on a monotonic clock.
class Stopwatch {
public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Adds the seconds of its lifetime to a sum.
class SumOfTime {
public:
    explicit SumOfTime(double& sum) : sum_(sum) {}
    ~SumOfTime() { sum_ += watch_.seconds(); }
    SumOfTime(const SumOfTime&) = delete;
    SumOfTime& operator=(const SumOfTime&) = delete;

private:
    double& sum_;
    Stopwatch watch_;
};

}  // namespace obscura
