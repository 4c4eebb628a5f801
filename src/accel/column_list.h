// accel/column_list.h - defines structures of arrays from lists that name each column once.
// SPDX-License-Identifier: Apache-2.0
//
// A list is a macro LIST(VECTOR, NUMBER, WORD, INTEGER) with one line per field:
//   VECTOR(origin, ox, oy, oz)  three columns of floats
//   NUMBER(pdf)                 one column of floats
//   WORD(slot)                  one column of uint32_t
//   INTEGER(primitive)          one column of int32_t
// To add a column: add a line to its list, and correct the bytes in the head of
// stages/path_state.h. The struct, its memory, loading, appending, sorting and writing back are
// made from the list (stages/column_lanes.h, stages/workspace.cpp).
#pragma once

#include <cstdint>
#include <type_traits>

namespace obscura {

/// Word, as constant as Float is.
template <typename Float, typename Word>
using LikeConst = std::conditional_t<std::is_const_v<Float>, const Word, Word>;

/// 32-bit words per entry of a structure of columns.
template <typename Columns>
inline constexpr int column_count = static_cast<int>(sizeof(Columns) / sizeof(void*));

}  // namespace obscura

#define OBSCURA_COLUMN_VECTOR(name, x, y, z) Float *x, *y, *z;  // NOLINT: names
#define OBSCURA_COLUMN_NUMBER(name) Float* name;
#define OBSCURA_COLUMN_WORD(name) LikeConst<Float, uint32_t>* name;    // NOLINT: names
#define OBSCURA_COLUMN_INTEGER(name) LikeConst<Float, int32_t>* name;  // NOLINT: names

#define OBSCURA_VISIT_VECTOR(name, x, y, z) visit(sets.x...), visit(sets.y...), visit(sets.z...);
#define OBSCURA_VISIT_ONE(name) visit(sets.name...);

#define OBSCURA_VISIT_FIELD3(name, x, y, z) visit(lanes.name, columns.x, columns.y, columns.z);
#define OBSCURA_VISIT_FIELD1(name) visit(lanes.name, columns.name);

/// Defines Name<float>, columns that may be written, and Name<const float>, a view of them.
///
/// Name::for_each_column(visit, sets...) calls visit(sets.ox...), visit(sets.oy...) and so on, for
/// one or several structures with these columns. Name::for_each_field(visit, lanes, columns) calls
/// visit(lanes.origin, columns.ox, columns.oy, columns.oz) and so on.
#define OBSCURA_COLUMNS(Name, LIST)                                                             \
    template <typename Float>                                                                   \
    struct Name {                                                                               \
        LIST(OBSCURA_COLUMN_VECTOR,                                                             \
             OBSCURA_COLUMN_NUMBER,                                                             \
             OBSCURA_COLUMN_WORD,                                                               \
             OBSCURA_COLUMN_INTEGER)                                                            \
                                                                                                \
        template <typename Visit, typename... Sets>                                             \
        __attribute__((always_inline)) static void for_each_column(const Visit& visit,          \
                                                                   Sets&... sets) {             \
            LIST(OBSCURA_VISIT_VECTOR, OBSCURA_VISIT_ONE, OBSCURA_VISIT_ONE, OBSCURA_VISIT_ONE) \
        }                                                                                       \
        template <typename Visit, typename Lanes, typename Columns>                             \
        __attribute__((always_inline)) static void for_each_field(const Visit& visit,           \
                                                                  Lanes& lanes,                 \
                                                                  const Columns& columns) {     \
            LIST(OBSCURA_VISIT_FIELD3,                                                          \
                 OBSCURA_VISIT_FIELD1,                                                          \
                 OBSCURA_VISIT_FIELD1,                                                          \
                 OBSCURA_VISIT_FIELD1)                                                          \
        }                                                                                       \
        __attribute__((always_inline)) operator Name<const Float>() const /* NOLINT */          \
            requires(!std::is_const_v<Float>) {                                                 \
            Name<const Float> view{}; /* NOLINT */                                              \
            const auto set = [](const auto& from, auto& to) __attribute__((always_inline)) {    \
                to = from;                                                                      \
            };                                                                                  \
            for_each_column(set, *this, view);                                                  \
            return view;                                                                        \
        }                                                                                       \
    }
