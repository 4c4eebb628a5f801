// light/alias_table.h - draws an index with given probabilities in constant time.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/row_words.h"
#include "math/lanes.h"

#include <cstdint>
#include <span>
#include <vector>

namespace obscura {

/// One cell of an alias table, read as two 32-bit words.
struct AliasEntry {
    uint32_t threshold;  ///< the cell's own index is kept while the fraction is below
    int32_t alias;       ///< the index taken otherwise
};

static_assert(sizeof(AliasEntry) == 2 * 4, "read as 32-bit words: no padding");

/// Entries that one table may have. Above, cells would be missed by 32-bit random numbers.
inline constexpr size_t max_alias_entries = size_t{1} << 24;

/// Builds the table; the same weights give the same table.
///
/// In      weights: at most max_alias_entries; negative and non-finite ones count as 0; when all
///         are 0, every index is equally likely
/// Out     an index with weight > 0 has a probability of at least 2^-32
/// Source  Vose, "A Linear Algorithm for Generating Random Numbers with a Given Distribution",
///         IEEE Trans. Software Engineering 17(9), 1991
std::vector<AliasEntry> build_alias_table(std::span<const double> weights);
std::vector<AliasEntry> build_alias_table(std::span<const float> weights);

/// What sample_alias really does: how many of the 2^32 random numbers lead to each index, as a
/// share. Densities made from it match the sampler exactly; the weights are met to about
/// count * 2^-32, relative to the mean probability.
std::vector<double> alias_probabilities(std::span<const AliasEntry> entries);

inline namespace OBSCURA_ISA {

template <typename F>
struct AliasSample {
    IntOf<F> index;
    UintOf<F> remaining;  ///< uniform again; its upper 24 bits are filled
};

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

/// Draws an index from the `count` entries that start at entries[first].
///
/// In      first + count <= 2^30; count in [1, max_alias_entries]; random: uniform 32 bits
/// Out     index in [0, count), relative to first; about 32 - log2(count) bits remain random
template <typename F>
OBSCURA_INLINE AliasSample<F> sample_alias_at(const AliasEntry* entries,
                                              const IntOf<F>& first,
                                              int count,
                                              const UintOf<F>& random) {
    using U = UintOf<F>;
    const auto size = static_cast<uint32_t>(count);
    const IntOf<F> cell = as_int(multiply_high(random, size));
    const U fraction = random * U(size);  // the product's lower half: where in the cell
    const IntOf<F> word = (first + cell) * IntOf<F>(words_per_row<AliasEntry>);
    const auto* thresholds = member_words<uint32_t>(entries, offsetof(AliasEntry, threshold));
    const auto* aliases = member_words<int32_t>(entries, offsetof(AliasEntry, alias));
    const U threshold = gather<F>(thresholds, word);
    const auto kept = fraction < threshold;
    const IntOf<F> index = select(kept, cell, gather<F>(aliases, word));

    const U low = select(kept, U(0U), threshold);
    const U width = select(kept, threshold, U(0U) - threshold);
    // A threshold of 0 leaves the whole cell, 2^32, to the alias; modulo 2^32 that is 0.
    const F span = select(width == U(0U), F(4294967296.0f), float_from_uint<F>(width));
    const F unit = (float_from_uint<F>(U(fraction - low)) + F(0.5f)) / span;
    const IntOf<F> bits = to_int(min(unit * F(16777216.0f), F(16777215.0f)));
    return {index, as_uint(bits) << 8};
}

template <typename F>
OBSCURA_INLINE AliasSample<F> sample_alias(const AliasEntry* entries,
                                           int count,
                                           const UintOf<F>& random) {
    return sample_alias_at<F>(entries, IntOf<F>(0), count, random);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
