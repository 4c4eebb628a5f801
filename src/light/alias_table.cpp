// light/alias_table.cpp - builds alias tables and tells the probabilities they really have.
// SPDX-License-Identifier: Apache-2.0
#include "light/alias_table.h"

#include <algorithm>
#include <cmath>

namespace obscura {
namespace {

constexpr double two_to_32 = 4294967296.0;
constexpr uint32_t always = 0xFFFFFFFFU;

double usable(double weight) {
    return weight > 0 && std::isfinite(weight) ? weight : 0;
}

/// Smallest random number whose product with `count` reaches `cell + fraction / 2^32`.
uint64_t first_random(uint64_t cell, uint64_t fraction, uint64_t count) {
    return ((cell << 32) + fraction + count - 1) / count;
}

/// A share of a cell, in 2^32nds. A cell holds every count-th fraction, so the first `count` of
/// them hold one: a weight that is not 0 keeps at least that.
uint32_t threshold_of(double share, size_t count, bool possible) {
    const double scaled = std::round(share * two_to_32);
    const double smallest = possible ? static_cast<double>(count) : 0.0;
    return static_cast<uint32_t>(std::clamp(scaled, smallest, two_to_32 - 1));
}

}  // namespace

std::vector<AliasEntry> build_alias_table(std::span<const double> weights) {
    const size_t count = weights.size();
    std::vector<AliasEntry> entries(count);
    double largest = 0;
    for (const double weight : weights)
        largest = std::max(largest, usable(weight));
    double sum = 0;  // of weights / largest: no sum of finite numbers overflows
    for (const double weight : weights)
        sum += largest > 0 ? usable(weight) / largest : 0;

    // A share of 1 fills a cell. Cells below 1 are topped up by those above.
    std::vector<double> shares(count, 1.0);
    std::vector<uint32_t> below;
    std::vector<uint32_t> above;
    for (uint32_t i = 0; i < count; ++i) {
        if (sum > 0) shares[i] = usable(weights[i]) / largest / sum * static_cast<double>(count);
        (shares[i] < 1 ? below : above).push_back(i);
        entries[i] = {always, static_cast<int32_t>(i)};
    }
    while (!below.empty() && !above.empty()) {
        const uint32_t small = below.back();
        const uint32_t large = above.back();
        below.pop_back();
        entries[small].threshold = threshold_of(shares[small], count, usable(weights[small]) > 0);
        entries[small].alias = static_cast<int32_t>(large);
        shares[large] -= 1 - shares[small];
        if (shares[large] < 1) {
            above.pop_back();
            below.push_back(large);
        }
    }
    return entries;  // what is left in either list is 1 up to rounding: full cells
}

std::vector<AliasEntry> build_alias_table(std::span<const float> weights) {
    const std::vector<double> wide(weights.begin(), weights.end());
    return build_alias_table(std::span<const double>(wide));
}

std::vector<double> alias_probabilities(std::span<const AliasEntry> entries) {
    const uint64_t count = entries.size();
    std::vector<double> probabilities(count, 0.0);
    for (uint64_t cell = 0; cell < count; ++cell) {
        const uint64_t begin = first_random(cell, 0, count);
        const uint64_t turn = first_random(cell, entries[cell].threshold, count);
        const uint64_t end = first_random(cell + 1, 0, count);
        probabilities[cell] += static_cast<double>(turn - begin) / two_to_32;
        const auto alias = static_cast<size_t>(entries[cell].alias);
        probabilities[alias] += static_cast<double>(end - turn) / two_to_32;
    }
    return probabilities;
}

}  // namespace obscura
