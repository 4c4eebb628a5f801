// light/cdf_table.h - draws an index with given probabilities by inverting their CDF.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/record_words.h"
#include "math/gather4.h"
#include "math/sampler.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace obscura {

/// One index of a table, read as two 32-bit words; a table has one entry more than indices.
struct CdfEntry {
    uint32_t first_random;  ///< smallest random number that leads to this index or a later one
    int32_t first_index;    ///< index of the smallest random number in this equal cell
};

static_assert(sizeof(CdfEntry) == 2 * 4, "read as 32-bit words: no padding");

/// Maximum number of indices. With more, some cells would get no random number.
inline constexpr size_t max_cdf_indices = size_t{1} << 24;

/// Distributes the 2^32 random numbers over the indices in proportion to weights, in order.
///
/// In      weights: at least one; negative and non-finite ones count as 0; when all are 0, all are
///         equal; step: a power of two of which all shares are multiples; 2^32 / step exceeds the
///         number of weights
/// Out     the first number of each index, and 2^32 at the end; weights above 0 get at least `step`
std::vector<uint64_t> share_randoms(std::span<const double> weights, uint64_t step);

/// Builds the table; the same weights give the same table.
///
/// The index grows with the random number, so that stratified numbers give stratified indices. An
/// alias table would draw in constant time but scatter neighbouring numbers.
///
/// In      weights: 1 to max_cdf_indices; as share_randoms takes them
/// Out     weights.size() + 1 entries; an index with weight > 0 has a probability of at least 2^-32
std::vector<CdfEntry> build_cdf_table(std::span<const double> weights);

/// The exact probabilities of sample_cdf: the fraction of the 2^32 random numbers that leads to
/// each index. Densities made from them match the sampler exactly. They differ from the weights by
/// about count * 2^-32, relative to the mean probability.
std::vector<double> cdf_probabilities(std::span<const CdfEntry> entries);

/// Spreads the random numbers of one index over all 32-bit numbers, so that what chose the index
/// can choose again within it. In integers: tables with many small shares need every bit.
struct CdfSpread {
    uint32_t first = 0;   ///< of the index' numbers
    uint32_t shift = 0;   ///< moves their count to between 2^31 and 2^32
    uint32_t factor = 0;  ///< 2^63 / that
};

/// In      index: with a probability above 0
CdfSpread cdf_spread(std::span<const CdfEntry> entries, size_t index);

inline namespace OBSCURA_ISA {

/// Bits 32 to 63 of a * b.
template <typename U>
OBSCURA_INLINE U multiply_high(const U& a, uint32_t b) {
    const U b_low(b & 0xFFFFU);
    const U b_high(b >> 16);
    const U a_low = a & U(0xFFFFU);
    const U a_high = a >> 16;
    const U middle = a_high * b_low + ((a_low * b_low) >> 16);
    const U carry = a_low * b_high + (middle & U(0xFFFFU));
    return a_high * b_high + (middle >> 16) + (carry >> 16);
}

/// Draws an index from the table of `count` indices.
///
/// In      count: in [1, max_cdf_indices]; random: uniform 32 bits
/// Out     index in [0, count)
/// Source  Chen and Asau, "On Generating Random Variates from an Empirical Distribution", AIIE
///         Transactions 6(2), 1974: the search begins at a cell of equal cells
template <typename F>
OBSCURA_INLINE IntOf<F> sample_cdf(const CdfEntry* entries, int count, const UintOf<F>& random) {
    using I = IntOf<F>;
    static_assert(offsetof(CdfEntry, first_random) == 0 && offsetof(CdfEntry, first_index) == 4);
    const auto* words = member_words<int32_t>(entries, 0);
    const auto* randoms = member_words<uint32_t>(entries, 0);
    const I cell = as_int(multiply_high(random, static_cast<uint32_t>(count)));
    const auto guide = gather4<F>(words, I(cell * I(2)));
    I low = guide.y;
    I high = guide.w;
    while (any(low < high)) {
        const I middle = as_int(as_uint(I(low + high + I(1))) >> 1);
        const auto beyond = random < gather<F>(randoms, I(middle * I(2)));
        high = select(beyond, I(middle - I(1)), high);
        low = select(beyond, low, middle);
    }
    return low;
}

/// A drawn index and where the random number lies among those that lead to it.
template <typename F>
struct CdfDraw {
    IntOf<F> index;
    F place;  ///< in [0, 1): as uniform and as well stratified as the random number was
};

/// As sample_cdf.
template <typename F>
OBSCURA_INLINE CdfDraw<F> draw_cdf(const CdfEntry* entries, int count, const UintOf<F>& random) {
    using I = IntOf<F>;
    using U = UintOf<F>;
    const I index = sample_cdf<F>(entries, count, random);
    const auto bounds = gather4<F>(member_words<int32_t>(entries, 0), I(index * I(2)));
    const U first = as_uint(bounds.x);
    const U numbers = as_uint(bounds.z) - first;  // 0: all 2^32
    const F all = select(as_int(numbers) == I(0), F(0x1p32f), float_from_uint<F>(numbers));
    const F place = (float_from_uint<F>(U(random - first)) + F(0.5f)) / all;
    return {index, min(place, F(0x1.fffffep-1f))};
}

/// In      random: one that leads to the index of `spread`; low_bit: of another random number
/// Out     uniform 32 bits
template <typename U>
OBSCURA_INLINE U spread_random(const CdfSpread& spread, const U& random, const U& low_bit) {
    const U place = (random - U(spread.first)) << static_cast<int>(spread.shift);
    return (multiply_high(place, spread.factor) << 1) | (low_bit & U(1U));
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
