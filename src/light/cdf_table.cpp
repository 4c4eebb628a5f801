// light/cdf_table.cpp - builds tables that draw an index, and tells the probabilities they have.
// SPDX-License-Identifier: Apache-2.0
#include "light/cdf_table.h"

#include <algorithm>
#include <cmath>

namespace obscura {
namespace {

constexpr uint64_t all_randoms = uint64_t{1} << 32;

double usable(double weight) {
    return weight > 0 && std::isfinite(weight) ? weight : 0;
}

/// How much of a sum each weight has, none above 1; equal parts when all are 0.
std::vector<double> parts_of(std::span<const double> weights) {
    double largest = 0;
    for (const double weight : weights)
        largest = std::max(largest, usable(weight));
    std::vector<double> parts(weights.size(), 1.0);
    for (size_t i = 0; largest > 0 && i < weights.size(); ++i)
        parts[i] = usable(weights[i]) / largest;  // no sum of these overflows
    return parts;
}

/// First random number of every index, and one past the last: each index with a part gets at
/// least one number, the others none.
std::vector<uint64_t> bounds_of(const std::vector<double>& parts) {
    const size_t count = parts.size();
    double sum = 0;
    for (const double part : parts)
        sum += part;
    std::vector<uint64_t> bounds(count + 1, 0);
    double below = 0;
    for (size_t i = 0; i < count; ++i) {
        below += parts[i];
        const auto end = static_cast<uint64_t>(std::llround(below / sum * 0x1p32));
        bounds[i + 1] = parts[i] > 0 ? std::max(end, bounds[i] + 1) : bounds[i];
    }
    uint64_t most = all_randoms;
    for (size_t i = count; i > 0 && (i == count || bounds[i] > most || parts[i] <= 0); --i) {
        bounds[i] = most;
        most -= parts[i - 1] > 0 ? 1U : 0U;
    }
    return bounds;
}

}  // namespace

std::vector<CdfEntry> build_cdf_table(std::span<const double> weights) {
    const size_t count = weights.size();
    const std::vector<double> parts = parts_of(weights);
    const std::vector<uint64_t> bounds = bounds_of(parts);
    size_t last = count - 1;
    while (parts[last] <= 0)
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

std::vector<CdfEntry> build_cdf_table(std::span<const float> weights) {
    const std::vector<double> wide(weights.begin(), weights.end());
    return build_cdf_table(std::span<const double>(wide));
}

std::vector<double> cdf_probabilities(std::span<const CdfEntry> entries) {
    std::vector<double> probabilities(entries.size() - 1);
    uint64_t begin = 0;
    for (size_t i = 0; i < probabilities.size(); ++i) {
        const uint64_t bound = entries[i + 1].first_random;
        // 2^32 is stored as 0: it ends the last index that is possible, and what follows.
        const uint64_t end = bound == 0 && i >= static_cast<size_t>(entries.back().first_index)
                                 ? all_randoms
                                 : bound;
        probabilities[i] = static_cast<double>(end - begin) * 0x1p-32;
        begin = end;
    }
    return probabilities;
}

}  // namespace obscura
