// render/sample_plan.cpp - adaptive sampling decides: numbers of samples, which pixels get more.
// SPDX-License-Identifier: Apache-2.0
#include "render/sample_plan.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace obscura {

namespace {

/// The samples that a pixel of each group wants are the factor times this.
std::vector<double> shares_of(const GroupSamples& groups) {
    std::vector<double> out(groups.sizes.size());
    for (size_t i = 0; i < out.size(); ++i) {
        out[i] = static_cast<double>(groups.deviations[i]) /
                 std::sqrt(static_cast<double>(groups.costs[i]));
    }
    return out;
}

/// The factor of all shares. With n = f s / sqrt(c) samples of a pixel of deviation s and cost c,
/// the mean of the squared errors s^2 / n is the mean of s sqrt(c) over f: so f is that mean over
/// the goal's square. A pixel counts as if its share were at most the one that the most samples
/// serve, which depends on f: the right side falls as f grows, so that bisection finds where both
/// are equal.
double factor_of_shares(const GroupSamples& groups,
                        std::span<const double> shares,
                        double noise,
                        double most) {
    const double square = noise * noise;
    double pixels = 0;
    double costs = 0;
    for (size_t i = 0; i < groups.sizes.size(); ++i) {
        pixels += groups.sizes[i];
        costs += groups.sizes[i] * static_cast<double>(groups.costs[i]);
    }
    // All pixels at the most: s sqrt(c) = c most / f, the mean of which is f times the square.
    double high = std::sqrt(most * costs / std::max(pixels, 1.0) / square);
    double low = 0;
    for (int step = 0; step < 40; ++step) {
        const double factor = 0.5 * (low + high);
        double sum = 0;
        for (size_t i = 0; i < groups.sizes.size(); ++i) {
            const double share = std::min(shares[i], most / factor);
            sum += groups.sizes[i] * share * static_cast<double>(groups.costs[i]);
        }
        const bool is_low = sum > factor * square * pixels;
        (is_low ? low : high) = factor;
    }
    return high;
}

/// The level that is nearest to a number of samples, of the present one and those that may follow.
int next_level(int samples, double wanted, std::span<const int> levels) {
    int out = samples;
    const auto above = std::upper_bound(levels.begin(), levels.end(), samples);
    for (auto level = above; level != levels.end(); ++level) {
        if (level != above && *level > 2 * samples) break;
        // The mean of two numbers that are told apart by their ratio is that of their logarithms.
        if (wanted <= std::sqrt(static_cast<double>(out) * *level)) break;
        out = *level;
    }
    return out;
}

}  // namespace

std::vector<int> sample_levels(int least, int most) {
    constexpr int64_t step = 16;
    std::vector<int> out = {least / 2};
    for (int64_t level = least; level < most; level *= 2) {
        out.push_back(static_cast<int>(level));
        const int64_t between = level + level / 2;
        if (level % 2 == 0 && between % step == 0 && between < most)
            out.push_back(static_cast<int>(between));
    }
    out.push_back(most);
    return out;
}

std::vector<int> next_samples(const GroupSamples& groups,
                              double noise,
                              std::span<const int> levels) {
    const std::vector<double> shares = shares_of(groups);
    const double factor = factor_of_shares(groups, shares, noise, levels.back());
    std::vector<int> out(groups.samples.begin(), groups.samples.end());
    for (size_t i = 0; i < out.size(); ++i) {
        if (groups.sizes[i] == 0) continue;
        out[i] = next_level(out[i], factor * shares[i], levels);
    }
    return out;
}

}  // namespace obscura
