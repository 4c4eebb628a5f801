// light/cdf_table.cpp - builds the tables that draw an index, and their exact probabilities.
// SPDX-License-Identifier: Apache-2.0
#include "light/cdf_table.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace obscura {
namespace {

constexpr uint64_t all_randoms = uint64_t{1} << 32;

double usable(double weight) {
    return weight > 0 && std::isfinite(weight) ? weight : 0;
}

/// Weights scaled so that none exceeds 1; equal ones when all are 0.
std::vector<double> parts_of(std::span<const double> weights) {
    double largest = 0;
    for (const double weight : weights)
        largest = std::max(largest, usable(weight));
    std::vector<double> parts(weights.size(), 1.0);
    for (size_t i = 0; largest > 0 && i < weights.size(); ++i)
        parts[i] = usable(weights[i]) / largest;  // no sum of these overflows
    return parts;
}

}  // namespace

// The minimum of one step is taken from all shares in proportion. Taken from the neighbours alone,
// it would starve the rim of a sun, which has far more weight than the sky before it.
std::vector<uint64_t> share_randoms(std::span<const double> weights, uint64_t step) {
    const std::vector<double> parts = parts_of(weights);
    double sum = 0;
    uint64_t possible = 0;
    for (const double part : parts) {
        sum += part;
        possible += part > 0 ? 1U : 0U;
    }
    const uint64_t steps = all_randoms / step;
    const auto shared = static_cast<double>(steps - possible);
    std::vector<uint64_t> bounds{0};
    double below = 0;
    uint64_t given = 0;
    for (const double part : parts) {
        below += part;
        given += part > 0 ? 1U : 0U;
        const double share = std::min(below / sum, 1.0);
        bounds.push_back(step * (given + static_cast<uint64_t>(std::llround(share * shared))));
    }
    return bounds;
}

std::vector<CdfEntry> build_cdf_table(std::span<const double> weights) {
    const size_t count = weights.size();
    const std::vector<uint64_t> bounds = share_randoms(weights, 1);
    size_t last = count - 1;
    while (bounds[last] == all_randoms)
        --last;
    std::vector<CdfEntry> entries(count + 1);
    size_t index = 0;
    for (size_t cell = 0; cell <= count; ++cell) {
        const uint64_t first_random = (cell * all_randoms + count - 1) / count;
        while (index < last && bounds[index + 1] <= first_random)
            ++index;
        entries[cell] = {static_cast<uint32_t>(bounds[cell]), static_cast<int32_t>(index)};
    }
    return entries;
}

std::vector<double> cdf_probabilities(std::span<const CdfEntry> entries) {
    std::vector<double> probabilities(entries.size() - 1);
    uint64_t begin = 0;
    for (size_t i = 0; i < probabilities.size(); ++i) {
        const uint64_t bound = entries[i + 1].first_random;
        // 2^32 is stored as 0: it ends the last possible index, and all impossible ones after it.
        const uint64_t end = bound == 0 && i >= static_cast<size_t>(entries.back().first_index)
                                 ? all_randoms
                                 : bound;
        probabilities[i] = static_cast<double>(end - begin) * 0x1p-32;
        begin = end;
    }
    return probabilities;
}

CdfSpread cdf_spread(std::span<const CdfEntry> entries, size_t index) {
    const uint32_t first = entries[index].first_random;
    const uint64_t end = entries[index + 1].first_random;
    const uint64_t numbers = (end == 0 ? all_randoms : end) - first;
    const uint64_t fitting = std::min(numbers, all_randoms - 1);
    const auto shift = static_cast<uint32_t>(std::countl_zero(static_cast<uint32_t>(fitting)));
    const uint64_t factor = (uint64_t{1} << 63) / (numbers << shift);
    return {first, shift, static_cast<uint32_t>(std::min(factor, all_randoms - 1))};
}

}  // namespace obscura
