// bench/standard_score.h - the arithmetic of `bench --standard`: noise, rounds, score.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/report.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace obscura::bench {

/// The noise of independent renderings of one picture: R, G and B of each pixel, one by one.
class NoiseOfRenderings {
public:
    /// In      pixels: interleaved, R, G and B first
    void add(std::span<const float> pixels, size_t channels);

    /// The relative mean squared error of one of them: over R, G and B of a pixel the sum of the
    /// variances, over the sum of the squared means and a hundredth of the square of the picture's
    /// mean (R + G + B); of that the mean over the pixels, without the thousandth where it is
    /// greatest. Two renderings or more.
    double relative_error() const;

    /// Of R, G and B over the picture.
    double mean() const;

private:
    size_t count_ = 0;
    std::vector<double> mean_, squares_;  ///< Source: Welford, 1962
};

/// What was measured of a scene.
struct StandardFigures {
    std::string name, what;
    size_t triangles = 0;           ///< with every instance
    double noise = 0;               ///< the error that samples a second are stated at
    double relative_error = 0;      ///< of one picture
    double expected_mean = 0;       ///< see StandardScene::mean
    double mean = 0;                ///< of the picture
    std::vector<double> seconds;    ///< of each round
    double samples_per_second = 0;  ///< of the median round

    /// Samples a second, times how many fewer are enough for the noise: errors fall as samples
    /// rise.
    double at_fixed_noise(double per_second) const { return per_second * noise / relative_error; }
};

struct StandardReport {
    Machine machine;
    std::string isa;
    int threads = 0;
    int width = 0, height = 0, samples_per_pixel = 0, max_bounces = 0;
    std::vector<StandardFigures> scenes;
    std::vector<double> rounds;  ///< score of each
    double score = 0;            ///< million samples a second at fixed noise: the median round
    double spread = 0;           ///< see spread_of_median
    bool is_steady = false;      ///< the spread is small enough
    std::vector<std::string> warnings;
};

/// The score stands when its spread is below this.
inline constexpr double steady_spread = 0.02;

double geometric_mean(std::span<const double> values);

/// How uncertain the median is: the width of the interval between two measured values that holds
/// the true median in 19 of 20 cases, as a share of the median. It becomes narrower with more
/// rounds, and a few that were disturbed do not widen it.
///
/// Source  the sign test: Conover, "Practical Nonparametric Statistics", 3.2
double spread_of_median(std::vector<double> values);

/// Fills in all that follows from times, errors and sizes.
void finish(StandardReport& report);

/// 1 % or more between the picture's mean and the standard's, as a sentence each.
std::vector<std::string> doubts_about(const StandardReport& report);

}  // namespace obscura::bench
