// light/cdf_table.h - draws an index with given probabilities, in the order of the random number.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/row_words.h"
#include "math/gather4.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace obscura {

/// One index of a table, read as two 32-bit words; a table has one entry more than indices.
struct CdfEntry {
    uint32_t first_random;  ///< smallest random number that leads to this index or a later one
    int32_t first_index;  ///< what the smallest random number in this cell of equal cells leads to
};

static_assert(sizeof(CdfEntry) == 2 * 4, "read as 32-bit words: no padding");

/// The same in half the memory, for many small tables: probabilities are multiples of 2^-16.
struct ShortCdfEntry {
    uint16_t first_random;  ///< upper half of the 32 bits, the lower is 0
    uint16_t first_index;
};

static_assert(sizeof(ShortCdfEntry) == 4, "read as one 32-bit word");

/// Indices that one table may have. Above, cells would be missed by the random numbers.
template <typename Entry>
inline constexpr size_t max_cdf_indices = size_t{1} << 24;
template <>
inline constexpr size_t max_cdf_indices<ShortCdfEntry> = size_t{1} << 14;

/// Entries after a table's last that must exist, with any content, for sampling reads them too.
template <typename Entry>
inline constexpr int cdf_padding = 0;
template <>
inline constexpr int cdf_padding<ShortCdfEntry> = 2;

/// Builds the table; the same weights give the same table.
///
/// The index grows with the random number, so that well-spread numbers lead to well-spread indices:
/// an alias table would draw in constant time, and tear neighbouring numbers apart.
///
/// In      weights: 1 to max_cdf_indices<Entry>; negative and non-finite ones count as 0; when all
///         are 0, every index is equally likely
/// Out     weights.size() + 1 entries; an index with weight > 0 has a probability of at least 2^-32
///         (ShortCdfEntry: 2^-16)
template <typename Entry = CdfEntry>
std::vector<Entry> build_cdf_table(std::span<const double> weights);

/// What sample_cdf really does: how many of the 2^32 random numbers lead to each index, as a share.
/// Densities made from it match the sampler exactly; the weights are met to about count * 2^-32
/// (ShortCdfEntry: 2^-16), relative to the mean probability.
std::vector<double> cdf_probabilities(std::span<const CdfEntry> entries);
std::vector<double> cdf_probabilities(std::span<const ShortCdfEntry> entries);

inline namespace OBSCURA_ISA {

template <typename F>
struct CdfSample {
    IntOf<F> index;
    UintOf<F> remaining;  ///< uniform again; its upper 24 bits are filled
};

/// Neighbouring entries, from one on: what one look at the memory brings.
template <typename F, int count>
struct CdfWindow {
    UintOf<F> first_random[count];  ///< with all 32 bits
    IntOf<F> first_index[2];
};

template <typename F>
OBSCURA_INLINE CdfWindow<F, 2> read_cdf(const CdfEntry* entries, const IntOf<F>& number) {
    static_assert(offsetof(CdfEntry, first_random) == 0 && offsetof(CdfEntry, first_index) == 4);
    const auto words =
        gather4<F>(member_words<int32_t>(entries, 0), IntOf<F>(number * IntOf<F>(2)));
    return {{as_uint(words.x), as_uint(words.z)}, {words.y, words.w}};
}

template <typename F>
OBSCURA_INLINE CdfWindow<F, 4> read_cdf(const ShortCdfEntry* entries, const IntOf<F>& number) {
    static_assert(offsetof(ShortCdfEntry, first_index) == 2 &&
                  std::endian::native == std::endian::little);
    const auto words = gather4<F>(member_words<int32_t>(entries, 0), number);
    return {{as_uint(words.x) << 16,
             as_uint(words.y) << 16,
             as_uint(words.z) << 16,
             as_uint(words.w) << 16},
            {as_int(as_uint(words.x) >> 16), as_int(as_uint(words.y) >> 16)}};
}

/// first_random of one entry.
template <typename F>
OBSCURA_INLINE UintOf<F> read_cdf_random(const CdfEntry* entries, const IntOf<F>& number) {
    return gather<F>(member_words<uint32_t>(entries, 0), IntOf<F>(number * IntOf<F>(2)));
}

template <typename F>
OBSCURA_INLINE UintOf<F> read_cdf_random(const ShortCdfEntry* entries, const IntOf<F>& number) {
    return gather<F>(member_words<uint32_t>(entries, 0), number) << 16;
}

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

/// A 32-bit number as F, rounded once.
template <typename F>
OBSCURA_INLINE F float_from_uint(const UintOf<F>& u) {
    return from_int<F>(as_int(u >> 16)) * F(65536.0f) + from_int<F>(as_int(u & UintOf<F>(0xFFFFU)));
}

/// Where sample_cdf_at begins to read.
template <typename F>
OBSCURA_INLINE IntOf<F> cdf_cell(const IntOf<F>& first, int count, const UintOf<F>& random) {
    return first + as_int(multiply_high(random, static_cast<uint32_t>(count)));
}

/// The indices that a random number may still lead to.
template <typename F>
struct CdfRange {
    IntOf<F> low, high;
};

/// First half of sample_cdf_at: the guide. The second half begins to read at first + low.
template <typename F, typename Entry>
OBSCURA_INLINE CdfRange<F> cdf_range_at(const Entry* entries,
                                        const IntOf<F>& first,
                                        int count,
                                        const UintOf<F>& random) {
    const auto guide = read_cdf<F>(entries, cdf_cell<F>(first, count, random));
    return {guide.first_index[0], guide.first_index[1]};
}

/// Second half of sample_cdf_at: the search.
template <typename F, typename Entry>
OBSCURA_INLINE CdfSample<F> search_cdf(const Entry* entries,
                                       const IntOf<F>& first,
                                       const CdfRange<F>& range,
                                       const UintOf<F>& random) {
    using U = UintOf<F>;
    using I = IntOf<F>;
    constexpr int steps = cdf_padding<Entry>;  // past `low` that the last look will find
    I low = range.low;
    I high = range.high;
    while (any(I(low + I(steps)) < high)) {
        const I middle = as_int(as_uint(I(low + high + I(1))) >> 1);
        const auto beyond = random < read_cdf_random<F>(entries, I(first + middle));
        high = select(beyond, I(middle - I(1)), high);
        low = select(beyond, low, middle);
    }
    const auto window = read_cdf<F>(entries, I(first + low));
    I index = low;
    U begin = window.first_random[0];
    U end = window.first_random[1];
    for (int step = 1; step <= steps; ++step) {
        const I next = low + I(step);
        const MaskOf<F> beyond = (next <= high) & !(random < window.first_random[step]);
        index = select(beyond, next, index);
        begin = select(beyond, window.first_random[step], begin);
        end = select(beyond, window.first_random[step + 1], end);
    }
    const U width = end - begin;
    // An index that takes all 2^32 numbers has a width of 2^32, modulo 2^32 that is 0.
    const F span = select(width == U(0U), F(4294967296.0f), float_from_uint<F>(width));
    const F unit = (float_from_uint<F>(U(random - begin)) + F(0.5f)) / span;
    const I bits = to_int(min(unit * F(16777216.0f), F(16777215.0f)));
    return {index, as_uint(bits) << 8};
}

/// Draws an index from the table of `count` indices that starts at entries[first].
///
/// In      entries: followed by cdf_padding<Entry>; first + count < 2^30; count in [1,
///         max_cdf_indices<Entry>]; random: uniform 32 bits
/// Out     index in [0, count), relative to first; the remainder is where the random number lies
///         among those that lead to the index
/// Source  Chen and Asau, "On Generating Random Variates from an Empirical Distribution", AIIE
///         Transactions 6(2), 1974: the search begins at a cell of equal cells
template <typename F, typename Entry>
OBSCURA_INLINE CdfSample<F> sample_cdf_at(const Entry* entries,
                                          const IntOf<F>& first,
                                          int count,
                                          const UintOf<F>& random) {
    return search_cdf<F>(entries, first, cdf_range_at<F>(entries, first, count, random), random);
}

template <typename F, typename Entry>
OBSCURA_INLINE CdfSample<F> sample_cdf(const Entry* entries, int count, const UintOf<F>& random) {
    return sample_cdf_at<F>(entries, IntOf<F>(0), count, random);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
