// stages/3_sort.cpp - keeps lanes full and alike: hits are parted from misses, and by surface.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_shade.h"
#include "stages/rows.h"

#include <cstring>
#include <type_traits>

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// Primitives that are told apart; beyond, several share a bucket.
constexpr uint32_t bucket_count = 1024;

/// The hits and misses of a batch by row number.
struct Order {
    SortedCounts counts;
    uint16_t hit[batch_rows];  ///< by primitive, in one primitive as they came
    uint16_t miss[batch_rows];
};
static_assert(batch_rows <= 65536);

/// Groups of rows that hit several primitives, or hit and miss.
int mixed_groups(int count, const HitView& hits) {
    int mixed = 0;
    for (int i = 0; i < count; i += lane_count) {
        const LanesI primitive = load(hits.primitive + i);
        const Mask differs = primitive != LanesI(first_lane(primitive));
        mixed += any(differs & rows_in_range(i, count)) ? 1 : 0;
    }
    return mixed;
}

void find_order(int count, const HitView& hits, Order& order) {
    uint16_t begins[bucket_count] = {};
    const auto bucket = [&](int row) {
        return static_cast<uint32_t>(hits.primitive[row]) % bucket_count;
    };
    int misses = 0;
    uint32_t last = 0;
    for (int i = 0; i < count; ++i) {
        if (hits.primitive[i] < 0) {
            order.miss[misses++] = static_cast<uint16_t>(i);
            continue;
        }
        ++begins[bucket(i)];
        last = last > bucket(i) ? last : bucket(i);
    }
    uint16_t next = 0;
    for (uint32_t k = 0; k <= last; ++k) {
        const uint16_t size = begins[k];
        begins[k] = next;
        next = static_cast<uint16_t>(next + size);
    }
    for (int i = 0; i < count; ++i) {
        if (hits.primitive[i] >= 0) order.hit[begins[bucket(i)]++] = static_cast<uint16_t>(i);
    }
    order.counts = {count - misses, misses};
}

void take_misses(const PathView& paths, const Order& order, const MissRows& out) {
    const auto column = [&](const auto* from, auto* to) {
        take_rows(order.miss, order.counts.misses, from, to);
    };
    MissRows::for_each_column(column, paths, out);
}

void sort_hits(const PathRows& paths, const HitRows& hits, const Order& order) {
    uint32_t sorted[batch_rows];
    const auto column = [&](auto* words) {
        using Word = std::remove_pointer_t<decltype(words)>;
        const int count = order.counts.hits;
        take_rows<Word>(order.hit, count, words, reinterpret_cast<Word*>(sorted));
        std::memcpy(words, sorted, static_cast<size_t>(count) * sizeof(Word));
    };
    PathRows::for_each_column(column, paths);
    HitRows::for_each_column(column, hits);
}

/// As sort_hits_from_misses, in the order in which the rows come: camera rays of neighbouring
/// pixels mostly meet the same surface as it is.
SortedCounts pack_hits(int count_in, const ShadeRows& rows) {
    SortedCounts sorted;
    for (int i = 0; i < count_in; i += lane_count) {
        const Mask exists = rows_in_range(i, count_in);
        const Mask is_hit = exists & (load(rows.hits.primitive + i) >= LanesI(0));
        const Mask is_miss = exists & (!is_hit);
        if (any(is_miss)) {
            sorted.misses = append_misses(rows.misses, sorted.misses, is_miss, rows.paths, i);
        }
        if (none(is_hit)) continue;
        if (none(is_miss) && sorted.hits == i) {  // where they belong already
            sorted.hits += count(is_hit);
            continue;
        }
        // In place: the rows written here have all been read.
        append_hits(rows.hits, sorted.hits, is_hit, load_hits(rows.hits, i));
        sorted.hits = append_paths(rows.paths, sorted.hits, is_hit, load_paths(rows.paths, i));
    }
    return sorted;
}

}  // namespace

SortedCounts sort_hits_from_misses(int count_in, const ShadeRows& rows) {
    const int groups = (count_in + lane_count - 1) / lane_count;
    if (mixed_groups(count_in, rows.hits) * 4 <= groups) return pack_hits(count_in, rows);
    Order order;
    find_order(count_in, rows.hits, order);
    take_misses(rows.paths, order, rows.misses);
    sort_hits(rows.paths, rows.hits, order);
    return order.counts;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
