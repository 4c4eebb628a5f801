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

/// First random number of every index, and one past the last, in multiples of `step`. Each index
/// with a part gets one step, and its share of the steps that are left; the others get none.
///
/// The one step must come out of all shares alike: taken from the neighbours alone it would starve
/// the rim of a sun, which shines far more than all the sky before it.
std::vector<uint64_t> bounds_of(const std::vector<double>& parts, uint64_t step) {
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

void set_entry(CdfEntry& entry, uint64_t first_random, size_t index) {
    entry = {static_cast<uint32_t>(first_random), static_cast<int32_t>(index)};
}

void set_entry(ShortCdfEntry& entry, uint64_t first_random, size_t index) {
    entry = {static_cast<uint16_t>(first_random >> 16), static_cast<uint16_t>(index)};
}

uint64_t random_of(const CdfEntry& entry) {
    return entry.first_random;
}

uint64_t random_of(const ShortCdfEntry& entry) {
    return uint64_t{entry.first_random} << 16;
}

template <typename Entry>
constexpr uint64_t step_of = 1;
template <>
constexpr uint64_t step_of<ShortCdfEntry> = uint64_t{1} << 16;

template <typename Entry>
std::vector<double> probabilities_of(std::span<const Entry> entries) {
    std::vector<double> probabilities(entries.size() - 1);
    uint64_t begin = 0;
    for (size_t i = 0; i < probabilities.size(); ++i) {
        const uint64_t bound = random_of(entries[i + 1]);
        // 2^32 is stored as 0: it ends the last index that is possible, and what follows.
        const uint64_t end = bound == 0 && i >= static_cast<size_t>(entries.back().first_index)
                                 ? all_randoms
                                 : bound;
        probabilities[i] = static_cast<double>(end - begin) * 0x1p-32;
        begin = end;
    }
    return probabilities;
}

}  // namespace

template <typename Entry>
std::vector<Entry> build_cdf_table(std::span<const double> weights) {
    const size_t count = weights.size();
    const std::vector<double> parts = parts_of(weights);
    const std::vector<uint64_t> bounds = bounds_of(parts, step_of<Entry>);
    size_t last = count - 1;
    while (parts[last] <= 0)
        --last;
    std::vector<Entry> entries(count + 1);
    size_t index = 0;
    for (size_t cell = 0; cell <= count; ++cell) {
        const uint64_t first_random = (cell * all_randoms + count - 1) / count;
        while (index < last && bounds[index + 1] <= first_random)
            ++index;
        set_entry(entries[cell], bounds[cell], index);
    }
    return entries;
}

template std::vector<CdfEntry> build_cdf_table(std::span<const double> weights);
template std::vector<ShortCdfEntry> build_cdf_table(std::span<const double> weights);

std::vector<double> cdf_probabilities(std::span<const CdfEntry> entries) {
    return probabilities_of(entries);
}

std::vector<double> cdf_probabilities(std::span<const ShortCdfEntry> entries) {
    return probabilities_of(entries);
}

}  // namespace obscura
