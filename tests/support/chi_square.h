// tests/support/chi_square.h - tests that a sampler draws samples with the density it claims.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"
#include "math/warp.h"

#include "support/random.h"
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace obscura {

/// Level of each of `tests` independent tests such that all of them together have `alpha`.
/// Source  Sidak, "Rectangular Confidence Regions ...", J. American Statistical Association 62,
/// 1967
inline double sidak_alpha(double alpha, int tests) {
    return 1 - std::pow(1 - alpha, 1.0 / tests);
}

/// Regularised upper incomplete gamma function Q(a, x): a series below a + 1, Lentz's continued
/// fraction above.
/// Source  Abramowitz and Stegun, "Handbook of Mathematical Functions", 6.5.29 and 6.5.31
inline double gamma_q(double a, double x) {
    if (!(x > 0)) return 1;
    const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
    if (x < a + 1) {
        double term = 1 / a;
        double sum = term;
        for (double n = a + 1; term > sum * 1e-16; ++n) {
            term *= x / n;
            sum += term;
        }
        return std::clamp(1 - front * sum, 0.0, 1.0);
    }
    double b = x + 1 - a;
    double c = 1e300;
    double d = 1 / b;
    double fraction = d;
    for (int n = 1; n < 100000; ++n) {
        const double numerator = -n * (n - a);
        b += 2;
        d = 1 / (numerator * d + b);
        c = b + numerator / c;
        fraction *= c * d;
        if (std::abs(c * d - 1) < 1e-15) break;
    }
    return std::clamp(front * fraction, 0.0, 1.0);
}

/// Probability that a chi-square variable with `degrees` is at least `statistic`.
inline double chi_square_p_value(double statistic, int degrees) {
    return gamma_q(0.5 * degrees, 0.5 * statistic);
}

struct ChiSquareOutcome {
    double statistic = 0;
    int degrees = 0;
    double p_value = 0;
    double expected_fraction = 0;  ///< integral of the density over all bins
    std::string problem;           ///< a failure that no statistic can excuse; then p_value is 0

    bool passes(double alpha) const { return problem.empty() && p_value > alpha; }
};

/// For test messages.
inline std::ostream& operator<<(std::ostream& out, const ChiSquareOutcome& outcome) {
    return out << "chi-square " << outcome.statistic << ", degrees " << outcome.degrees << ", p "
               << outcome.p_value << ", integral " << outcome.expected_fraction << ' '
               << outcome.problem;
}

/// Compares counts with expectations. Bins that expect fewer than 5 are pooled, smallest first.
inline ChiSquareOutcome chi_square(const std::vector<double>& observed,
                                   const std::vector<double>& expected) {
    constexpr double least = 5;
    ChiSquareOutcome outcome;
    std::vector<size_t> order(expected.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(
        order.begin(), order.end(), [&](size_t a, size_t b) { return expected[a] < expected[b]; });
    struct Cell {
        double observed = 0, expected = 0;
    };
    std::vector<Cell> cells(1);
    for (const size_t i : order) {
        if (expected[i] <= 1e-3 && observed[i] > 3) {
            outcome.problem = "samples where the density is zero, bin " + std::to_string(i);
        }
        if (cells.back().expected >= least) cells.emplace_back();
        cells.back().observed += observed[i];
        cells.back().expected += expected[i];
    }
    if (cells.size() > 1 && cells.back().expected < least) {
        const Cell rest = cells.back();
        cells.pop_back();
        cells.back().observed += rest.observed;
        cells.back().expected += rest.expected;
    }
    if (cells.size() < 2) outcome.problem = "fewer than two bins expect 5 samples or more";
    for (const Cell& cell : cells) {
        const double difference = cell.observed - cell.expected;
        outcome.statistic += difference * difference / std::max(cell.expected, 1e-300);
    }
    outcome.degrees = static_cast<int>(cells.size()) - 1;
    if (outcome.problem.empty()) {
        outcome.p_value = chi_square_p_value(outcome.statistic, outcome.degrees);
    }
    return outcome;
}

/// Integral of f(x, y) over rectangles: a 3 x 3 Gauss-Legendre rule, halved on both sides until it
/// converges. Resolves jumps of the density (pixel borders) to 2^-depth of a bin, but misses a jump
/// that only grazes a bin: where jumps are large, align bins and borders.
struct Quadrature {
    double absolute = 2e-7;
    double relative = 1e-4;
    double largest = 1e-5;  ///< largest value of one rectangle: a jump at its rim could go unseen
    int min_depth = 3;      ///< finds features that are small against a bin
    int max_depth = 9;

    struct Box {
        double x0, x1, y0, y1;
    };

    template <typename Function>
    double integrate(const Function& f, const Box& box) const {
        return refine(f, box, rule(f, box), 0);
    }

private:
    template <typename Function>
    static double rule(const Function& f, const Box& box) {
        constexpr double node[] = {-0.774596669241483377, 0, 0.774596669241483377};
        constexpr double weight[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
        double sum = 0;
        for (int i = 0; i < 3; ++i) {
            const double x = 0.5 * (box.x0 + box.x1 + (box.x1 - box.x0) * node[i]);
            for (int j = 0; j < 3; ++j) {
                const double y = 0.5 * (box.y0 + box.y1 + (box.y1 - box.y0) * node[j]);
                sum += weight[i] * weight[j] * f(x, y);
            }
        }
        return sum * (box.x1 - box.x0) * (box.y1 - box.y0);
    }

    template <typename Function>
    double refine(const Function& f, const Box& box, double coarse, int depth) const {
        const double x = 0.5 * (box.x0 + box.x1);
        const double y = 0.5 * (box.y0 + box.y1);
        const Box parts[] = {{box.x0, x, box.y0, y},
                             {x, box.x1, box.y0, y},
                             {box.x0, x, y, box.y1},
                             {x, box.x1, y, box.y1}};
        double values[4];
        double fine = 0;
        for (int i = 0; i < 4; ++i)
            fine += values[i] = rule(f, parts[i]);
        const bool settled = std::abs(fine - coarse) <= absolute + relative * std::abs(fine) &&
                             std::abs(fine) <= largest;
        if (!std::isfinite(fine)) return fine;
        if (depth >= max_depth || (settled && depth >= min_depth)) return fine;
        double sum = 0;
        for (int i = 0; i < 4; ++i)
            sum += refine(f, parts[i], values[i], depth + 1);
        return sum;
    }
};

struct ChiSquareOptions {
    int x_bins = 80;  ///< azimuth on the sphere
    int y_bins = 40;  ///< cosine of the polar angle on the sphere
    int samples = 1000000;
    uint64_t seed = 1;
    int axis = 2;         ///< of the polar angle: 0 x, 1 y, 2 z
    bool misses = false;  ///< the sampler may return nothing, with the rest of the density
    Quadrature quadrature = {};
};

/// Common part: `sample` gives a point in the unit square (or nothing), `density` the expected
/// density there; both axes have bins of equal size.
///
/// In      sample: std::optional<Vec2<double>>(Pcg32&); density: double(double x, double y)
template <typename Sample, typename Density>
ChiSquareOutcome chi_square_on_square(const Sample& sample,
                                      const Density& density,
                                      const ChiSquareOptions& options) {
    const auto bins = static_cast<size_t>(options.x_bins * options.y_bins);
    std::vector<double> observed(bins + 1, 0.0);  // the last one counts misses
    std::vector<double> expected(bins + 1, 0.0);
    Pcg32 random(options.seed);
    bool outside = false;
    for (int i = 0; i < options.samples; ++i) {
        const std::optional<Vec2<double>> place = sample(random);
        if (place && !(place->x >= 0 && place->x <= 1 && place->y >= 0 && place->y <= 1)) {
            outside = true;  // NaN too
            continue;
        }
        size_t bin = bins;
        if (place) {
            const int x = std::min(static_cast<int>(place->x * options.x_bins), options.x_bins - 1);
            const int y = std::min(static_cast<int>(place->y * options.y_bins), options.y_bins - 1);
            bin = static_cast<size_t>(y * options.x_bins + x);
        }
        observed[bin] += 1;
    }
    double share = 0;
    for (size_t i = 0; i < bins; ++i) {
        const auto x = static_cast<double>(i % static_cast<size_t>(options.x_bins));
        const auto y = static_cast<double>(i / static_cast<size_t>(options.x_bins));
        const double integral = options.quadrature.integrate(density,
                                                             {x / options.x_bins,
                                                              (x + 1) / options.x_bins,
                                                              y / options.y_bins,
                                                              (y + 1) / options.y_bins});
        share += integral;
        expected[i] = integral * options.samples;
    }
    if (!std::isfinite(share)) return {.problem = "the density is not finite"};
    const bool whole = options.misses ? share < 1.002 : std::abs(share - 1) < 0.002;
    if (options.misses) {
        expected[bins] = std::max(1 - share, 0.0) * options.samples;
    } else {
        outside = outside || observed[bins] > 0;
        observed.pop_back();
        expected.pop_back();
    }
    ChiSquareOutcome outcome = chi_square(observed, expected);
    outcome.expected_fraction = share;
    if (outside) outcome.problem += " samples outside of the domain or missing";
    if (!whole) outcome.problem += " the density does not integrate to 1";
    if (!outcome.problem.empty()) outcome.p_value = 0;
    return outcome;
}

/// A direction from its azimuth and cosine, both scaled to [0, 1].
inline Vec3d direction_at(double x, double y, int axis) {
    const double cosine = 2 * y - 1;
    const double sine = std::sqrt(std::max(1 - cosine * cosine, 0.0));
    const double a = sine * std::cos(2 * pi_d * x);
    const double b = sine * std::sin(2 * pi_d * x);
    if (axis == 0) return {cosine, a, b};
    if (axis == 1) return {a, cosine, b};
    return {a, b, cosine};
}

/// Inverse of direction_at.
inline Vec2<double> place_of(const Vec3d& d, int axis) {
    const double cosine = axis == 0 ? d.x : axis == 1 ? d.y : d.z;
    const double a = axis == 0 ? d.y : d.x;
    const double b = axis == 2 ? d.y : d.z;
    const double turn = std::atan2(b, a) / (2 * pi_d);
    return {turn < 0 ? turn + 1 : turn, std::clamp(0.5 * (cosine + 1), 0.0, 1.0)};
}

/// Tests a sampler of directions.
///
/// In      sample: std::optional<Vec3d>(Pcg32&), unit; pdf: double(const Vec3d&), 1/sr
template <typename Sample, typename Pdf>
ChiSquareOutcome chi_square_on_sphere(const Sample& sample,
                                      const Pdf& pdf,
                                      const ChiSquareOptions& options = {}) {
    int bent = 0;
    const auto place = [&](Pcg32& random) -> std::optional<Vec2<double>> {
        const std::optional<Vec3d> direction = sample(random);
        if (!direction) return std::nullopt;
        bent += std::abs(dot(*direction, *direction) - 1) < 1e-4 ? 0 : 1;  // NaN counts
        return place_of(*direction, options.axis);
    };
    const auto density = [&](double x, double y) {
        return pdf(direction_at(x, y, options.axis)) * 4 * pi_d;
    };
    ChiSquareOutcome outcome = chi_square_on_square(place, density, options);
    if (bent > 0) {
        outcome.problem += " directions that are not unit vectors: " + std::to_string(bent);
        outcome.p_value = 0;
    }
    return outcome;
}

}  // namespace obscura
