// render/filter_table.cpp - pixel reconstruction filters as inverse cumulative distributions.
// SPDX-License-Identifier: Apache-2.0
#include "render/filter_table.h"

#include "stages/path_state.h"

#include <cmath>

namespace obscura {

namespace {

struct Shape {
    double radius;
    double (*value)(double x, double radius);
};

double gaussian(double x, double) {
    const double sigma = 0.5;
    return std::exp(-x * x / (2.0 * sigma * sigma));
}

double blackman_harris(double x, double radius) {
    const double turn = pi_d * (x / radius + 1.0);
    return 0.35875 - 0.48829 * std::cos(turn) + 0.14128 * std::cos(2.0 * turn) -
           0.01168 * std::cos(3.0 * turn);
}

}  // namespace

std::vector<float> make_filter_table(PixelFilter filter) {
    if (filter == PixelFilter::box) return {};
    const Shape shape =
        filter == PixelFilter::gaussian ? Shape{1.5, gaussian} : Shape{1.65, blackman_harris};
    // Cumulative sums by the midpoint rule, then the offsets at which they reach k / entries.
    constexpr int steps = 1 << 16;
    const double width = 2.0 * shape.radius / steps;
    std::vector<double> cumulative(steps + 1, 0.0);
    for (int i = 0; i < steps; ++i) {
        const double x = -shape.radius + (i + 0.5) * width;
        cumulative[static_cast<size_t>(i) + 1] =
            cumulative[static_cast<size_t>(i)] + shape.value(x, shape.radius);
    }
    std::vector<float> table(filter_entries + 1);
    size_t step = 0;
    for (size_t k = 0; k <= filter_entries; ++k) {
        const double target = cumulative.back() * static_cast<double>(k) / filter_entries;
        while (step + 1 < cumulative.size() && cumulative[step + 1] < target)
            ++step;
        const double low = cumulative[step];
        const double high = cumulative[std::min(step + 1, cumulative.size() - 1)];
        const double within = high > low ? (target - low) / (high - low) : 0.0;
        table[k] = static_cast<float>(-shape.radius + (static_cast<double>(step) + within) * width);
    }
    return table;
}

}  // namespace obscura
