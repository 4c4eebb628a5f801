// bench/standard_score.cpp - the arithmetic of `bench --standard`: noise, rounds, score.
// SPDX-License-Identifier: Apache-2.0
#include "bench/standard_score.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

namespace obscura::bench {

void NoiseOfRenderings::add(std::span<const float> pixels, size_t channels) {
    const size_t values = pixels.size() / channels * 3;
    mean_.resize(values);
    squares_.resize(values);
    ++count_;
    for (size_t i = 0; i < values; ++i) {
        const double value = static_cast<double>(pixels[i / 3 * channels + i % 3]);
        const double before = value - mean_[i];
        mean_[i] += before / static_cast<double>(count_);
        squares_[i] += before * (value - mean_[i]);
    }
}

double NoiseOfRenderings::mean() const {
    const double sum = std::accumulate(mean_.begin(), mean_.end(), 0.0);
    return sum / static_cast<double>(mean_.size());
}

double NoiseOfRenderings::relative_error() const {
    constexpr size_t fireflies = 1000;  // one pixel in so many is left out
    const double brightness = 3 * mean();
    std::vector<double> errors(mean_.size() / 3);
    for (size_t pixel = 0; pixel < errors.size(); ++pixel) {
        double variance = 0;
        double square = 0.01 * brightness * brightness;
        for (size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) {
            variance += squares_[i] / static_cast<double>(count_ - 1);
            square += mean_[i] * mean_[i];
        }
        errors[pixel] = square > 0 ? variance / square : 0;
    }
    std::sort(errors.begin(), errors.end());
    errors.resize(errors.size() - errors.size() / fireflies);
    const double sum = std::accumulate(errors.begin(), errors.end(), 0.0);
    return sum / static_cast<double>(errors.size());
}

double geometric_mean(std::span<const double> values) {
    double sum = 0;
    for (const double value : values)
        sum += std::log(value);
    return values.empty() ? 0 : std::exp(sum / static_cast<double>(values.size()));
}

double spread_of_median(std::vector<double> values) {
    if (values.size() < 2) return 1;
    std::sort(values.begin(), values.end());
    // Ranks from 1 on: of n values each is below the median with a chance of one half.
    const auto count = static_cast<double>(values.size());
    const double half_width = 0.98 * std::sqrt(count);  // 1.96 / 2
    const double low = std::max(std::floor(0.5 * (count + 1) - half_width), 1.0);
    const auto rank = static_cast<size_t>(low) - 1;
    const double median = spread_of(values).median;
    return (values[values.size() - 1 - rank] - values[rank]) / median;
}

void finish(StandardReport& report) {
    const double samples = static_cast<double>(report.width) * report.height *
                           static_cast<double>(report.samples_per_pixel);
    report.rounds.clear();
    const size_t rounds = report.scenes.empty() ? 0 : report.scenes.front().seconds.size();
    for (size_t round = 0; round < rounds; ++round) {
        std::vector<double> speeds;
        for (const StandardFigures& scene : report.scenes)
            speeds.push_back(1e-6 * scene.at_fixed_noise(samples / scene.seconds[round]));
        report.rounds.push_back(geometric_mean(speeds));
    }
    for (StandardFigures& scene : report.scenes)
        scene.samples_per_second = samples / spread_of(scene.seconds).median;
    report.score = spread_of(report.rounds).median;
    report.spread = spread_of_median(report.rounds);
    report.is_steady = report.spread < steady_spread;
}

std::vector<std::string> doubts_about(const StandardReport& report) {
    std::vector<std::string> out;
    for (const StandardFigures& scene : report.scenes) {
        const double off = scene.mean / scene.expected_mean - 1;
        if (std::abs(off) <= 0.01) continue;
        out.push_back(fmt::format(
            "{}: the picture is {:+.1f} % brighter than the standard's, so it is another one and "
            "the score does not count",
            scene.name,
            100 * off));
    }
    if (!report.is_steady) {
        out.push_back(fmt::format(
            "after {} rounds the score is still uncertain by {:.1f} %; below {:.0f} % are needed: "
            "wait until nothing else runs here",
            report.rounds.size(),
            100 * report.spread,
            100 * steady_spread));
    }
    return out;
}

}  // namespace obscura::bench
