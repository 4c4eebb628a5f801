// bench/spread.cpp - median and range of repeated measurements.
// SPDX-License-Identifier: Apache-2.0
#include "bench/spread.h"

#include <algorithm>

namespace obscura::bench {

Spread spread_of(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const size_t middle = values.size() / 2;
    const double median =
        values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
    return {median, values.front(), values.back(), values.size()};
}

}  // namespace obscura::bench
