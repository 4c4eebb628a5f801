// light/row_words.h - reads one member of many rows as a column with a stride of whole rows.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/lanes.h"
#include "math/word_of.h"

#include <cstddef>

namespace obscura {
inline namespace OBSCURA_ISA {

/// The member at `byte_offset` of rows[0], to be indexed by row * words_per_row. Made from the
/// rows' own address on purpose: a pointer taken to the member (&rows->member) may be assumed by
/// the compiler never to leave it, and stores to other rows or members then get lost.
template <typename Word, typename Row>
OBSCURA_INLINE const Word* member_words(const Row* rows, size_t byte_offset) {
    static_assert(sizeof(Word) == 4 && sizeof(Row) % 4 == 0);
    return reinterpret_cast<const Word*>(reinterpret_cast<const char*>(rows) + byte_offset);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
