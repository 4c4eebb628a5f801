// math/table_row.h - a row of a table for every lane, for less where the lanes share it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/gather4.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// One row of a table of 32-bit words for every lane. Neighbouring hits mostly lie on the same
/// surface: where all lanes want the same row, a scalar load serves them in place of a gather.
template <typename F>
class TableRow {
public:
    TableRow() = default;

    /// In  row: row numbers, valid in idle lanes too; row_words: words from row to row
    OBSCURA_INLINE TableRow(const void* table, const IntOf<F>& row, int row_words)
        : words_(static_cast<const int32_t*>(table)), first_(row * IntOf<F>(row_words)) {
        const int32_t row_of_first = first_lane(row);
        shared_ = all(row == IntOf<F>(row_of_first));
        row_words_ = words_ + static_cast<int64_t>(row_of_first) * row_words;
    }

    /// True when all lanes have the same row; then one_integer tells a word of it.
    OBSCURA_INLINE bool shared() const { return shared_; }
    OBSCURA_INLINE int32_t one_integer(int word) const { return row_words_[word]; }

    OBSCURA_INLINE IntOf<F> integer(int word) const {
        if (shared_) return IntOf<F>(row_words_[word]);
        return gather<F>(words_ + word, first_);
    }

    /// Another word for every lane.
    OBSCURA_INLINE IntOf<F> varying_integer(const IntOf<F>& word) const {
        return gather<F>(words_, IntOf<F>(first_ + word));
    }

    OBSCURA_INLINE F number(int word) const {
        if (shared_) return F(bits_float(row_words_[word]));
        return gather<F>(reinterpret_cast<const float*>(words_) + word, first_);
    }

    /// Numbers [word, word + 4), all within the row.
    OBSCURA_INLINE Four<F> four_numbers(int word) const {
        if (shared_) {
            const auto one = [&](int k) { return F(bits_float(row_words_[word + k])); };
            return {one(0), one(1), one(2), one(3)};
        }
        return gather4<F>(reinterpret_cast<const float*>(words_) + word, first_);
    }

private:
    const int32_t* words_ = nullptr;
    const int32_t* row_words_ = nullptr;  ///< the first lane's row
    IntOf<F> first_{};                    ///< word at which each lane's row begins
    bool shared_ = false;
};

}  // namespace OBSCURA_ISA
}  // namespace obscura
