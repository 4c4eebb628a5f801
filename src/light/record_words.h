// light/record_words.h - reads one member of many records as a strided column.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/lanes.h"
#include "math/word_of.h"

#include <cstddef>

namespace obscura {
inline namespace OBSCURA_ISA {

/// The member at `byte_offset` of the first record, to be indexed by record * words_per_record.
/// Derived from the array's own address on purpose: compilers may assume that a pointer to a member
/// (&records->member) never leaves it, and then lose stores to other records or members.
template <typename Word, typename Record>
OBSCURA_INLINE const Word* member_words(const Record* records, size_t byte_offset) {
    static_assert(sizeof(Word) == 4 && sizeof(Record) % 4 == 0);
    return reinterpret_cast<const Word*>(reinterpret_cast<const char*>(records) + byte_offset);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
