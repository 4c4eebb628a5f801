// bench/spread.h - median and range of repeated measurements.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace obscura::bench {

/// Median, least and greatest of several measurements.
struct Spread {
    double median = 0;
    double low = 0;
    double high = 0;
    size_t count = 0;  ///< of measurements; 0: not measured, or not known

    /// Width of the range relative to the median; 0 when that is 0.
    double relative() const { return median != 0 ? (high - low) / median : 0; }
};

/// All zero for no values. Of an even number of values the median is the mean of the middle two.
Spread spread_of(std::vector<double> values);

}  // namespace obscura::bench
