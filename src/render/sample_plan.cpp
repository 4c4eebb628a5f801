// render/sample_plan.cpp - adaptive sampling decides: numbers of samples, which pixels get more.
// SPDX-License-Identifier: Apache-2.0
#include "render/sample_plan.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace obscura {

namespace {

/// A pixel goes on when it wants more than its samples times this: doubling them is then nearer to
/// what it wants, as a ratio, than leaving them.
constexpr double worth_doubling = 1.4142135623730951;

/// Samples per deviation. With n = f s samples of a pixel of deviation s, the mean of the squared
/// errors s^2 / n is the mean of s over f: so f is the mean of s over the goal's square. A pixel
/// counts as if its deviation were at most the one that the most samples serve, which depends on f:
/// the right side falls as f grows, so that bisection finds where both are equal.
double samples_per_deviation(std::span<const float> deviations, const NoiseGoal& goal) {
    const double most = goal.max_samples;
    const double square = goal.noise * goal.noise;
    // All pixels at the most: f = most / s and f = s / square, whence f = sqrt(most / square).
    double high = std::sqrt(most / square);
    double low = 0;
    for (int step = 0; step < 60; ++step) {
        const double factor = 0.5 * (low + high);
        double sum = 0;
        for (const float deviation : deviations)
            sum += std::min(static_cast<double>(deviation), most / factor);
        const bool is_low = sum > factor * square * static_cast<double>(deviations.size());
        (is_low ? low : high) = factor;
    }
    return high;
}

}  // namespace

std::vector<int> sample_levels(int least, int most) {
    std::vector<int> out = {least / 2};
    for (int64_t level = least; level < most; level *= 2)
        out.push_back(static_cast<int>(level));
    out.push_back(most);
    return out;
}

std::vector<uint8_t> pixels_in_need(std::span<const float> deviations,
                                    std::span<const int> samples,
                                    const NoiseGoal& goal) {
    const double factor = samples_per_deviation(deviations, goal);
    std::vector<uint8_t> out(deviations.size());
    for (size_t i = 0; i < out.size(); ++i) {
        const bool has_all = samples[i] >= goal.max_samples;
        const double wanted = factor * static_cast<double>(deviations[i]);
        out[i] = !has_all && wanted > worth_doubling * samples[i] ? 1 : 0;
    }
    return out;
}

}  // namespace obscura
