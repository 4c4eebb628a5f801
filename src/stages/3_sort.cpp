// stages/3_sort.cpp - sorts paths before shading: hits apart from misses, and hits by primitive.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_shade.h"
#include "stages/column_lanes.h"

#include <cstring>
#include <type_traits>

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// With more primitives than this, several share a bucket. Paths that the light tree chooses a
/// light for have buckets of their own, after those of the others.
constexpr uint32_t bucket_count = 1024;

/// The hits of a batch, as path indices.
struct Order {
    int hits = 0;
    uint16_t hit[batch_size];  ///< by primitive; within one primitive in their old order
};
static_assert(batch_size <= 65536);

/// Number of groups whose lanes hit several primitives, or both hit and miss.
int mixed_groups(int count, const HitView& hits) {
    int mixed = 0;
    for (int i = 0; i < count; i += lane_count) {
        const LanesI primitive = load(hits.primitive + i);
        const Mask differs = primitive != LanesI(first_lane(primitive));
        mixed += any(differs & lanes_in_range(i, count)) ? 1 : 0;
    }
    return mixed;
}

/// Moves the misses to columns.misses.
///
/// Out     hits: the path indices of the others, ascending, and some words more
SortedCounts take_misses(int count_in, const ShadeColumns& columns, int32_t* hits) {
    SortedCounts sorted;
    for (int i = 0; i < count_in; i += lane_count) {
        const Mask exists = lanes_in_range(i, count_in);
        const Mask is_hit = exists & (load(columns.hits.primitive + i) >= LanesI(0));
        const Mask is_miss = exists & (!is_hit);
        if (any(is_miss)) {
            sorted.misses = append_misses(columns.misses, sorted.misses, is_miss, columns.paths, i);
        }
        if (none(is_hit)) continue;
        store(hits + sorted.hits, pack(Packer(is_hit), LanesI(i) + lane_numbers()));
        sorted.hits += count(is_hit);
    }
    return sorted;
}

/// In      hits: indices of `count` paths that hit something
void find_order(
    const int32_t* hits, int count, const HitView& at, const TreeDraws* tree_draws, Order& order) {
    uint16_t begins[2 * bucket_count] = {};
    const auto bucket = [&](int index) {
        const uint32_t own = static_cast<uint32_t>(at.primitive[index]) % bucket_count;
        if (tree_draws == nullptr) return own;
        const uint32_t group = tree_draws->by_group[index / lane_count];
        return own + bucket_count * ((group >> (index % lane_count)) & 1U);
    };
    uint32_t last = 0;
    for (int k = 0; k < count; ++k) {
        const uint32_t own = bucket(hits[k]);
        ++begins[own];
        last = last > own ? last : own;
    }
    uint16_t next = 0;
    for (uint32_t k = 0; k <= last; ++k) {
        const uint16_t size = begins[k];
        begins[k] = next;
        next = static_cast<uint16_t>(next + size);
    }
    for (int k = 0; k < count; ++k)
        order.hit[begins[bucket(hits[k])]++] = static_cast<uint16_t>(hits[k]);
    order.hits = count;
}

void sort_hits(const PathColumns& paths, const HitColumns& hits, const Order& order) {
    uint32_t sorted[batch_size];
    const auto column = [&](auto* words) {
        using Word = std::remove_pointer_t<decltype(words)>;
        take_entries<Word>(order.hit, order.hits, words, reinterpret_cast<Word*>(sorted));
        std::memcpy(words, sorted, static_cast<size_t>(order.hits) * sizeof(Word));
    };
    PathColumns::for_each_column(column, paths);
    HitColumns::for_each_column(column, hits);
}

/// As sort_hits_from_misses, but keeps the order of the hits: camera rays of neighbouring pixels
/// mostly hit the same surface anyway.
SortedCounts pack_hits(int count_in, const ShadeColumns& columns) {
    SortedCounts sorted;
    for (int i = 0; i < count_in; i += lane_count) {
        const Mask exists = lanes_in_range(i, count_in);
        const Mask is_hit = exists & (load(columns.hits.primitive + i) >= LanesI(0));
        const Mask is_miss = exists & (!is_hit);
        if (any(is_miss)) {
            sorted.misses = append_misses(columns.misses, sorted.misses, is_miss, columns.paths, i);
        }
        if (none(is_hit)) continue;
        if (none(is_miss) && sorted.hits == i) {  // already in their final position
            sorted.hits += count(is_hit);
            continue;
        }
        // In place: the entries written here have all been read.
        append_hits(columns.hits, sorted.hits, is_hit, load_hits(columns.hits, i));
        sorted.hits =
            append_paths(columns.paths, sorted.hits, is_hit, load_paths(columns.paths, i));
    }
    return sorted;
}

}  // namespace

SortedCounts sort_hits_from_misses(int count_in,
                                   const ShadeColumns& columns,
                                   const TreeDraws* tree_draws) {
    const int groups = (count_in + lane_count - 1) / lane_count;
    if (tree_draws == nullptr && mixed_groups(count_in, columns.hits) * 4 <= groups)
        return pack_hits(count_in, columns);
    int32_t hits[batch_size + lane_count];
    const SortedCounts sorted = take_misses(count_in, columns, hits);
    Order order;
    find_order(hits, sorted.hits, columns.hits, tree_draws, order);
    sort_hits(columns.paths, columns.hits, order);
    return sorted;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
