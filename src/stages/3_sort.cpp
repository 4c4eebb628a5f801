// stages/3_sort.cpp - keeps lanes full: hits and misses are parted before they are shaded.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_shade.h"
#include "stages/rows.h"

namespace obscura {
inline namespace OBSCURA_ISA {

SortedCounts sort_hits_from_misses(int count_in, const ShadeRows& rows) {
    SortedCounts sorted;
    for (int i = 0; i < count_in; i += lane_count) {
        const Mask exists = rows_in_range(i, count_in);
        const PathLanes path = load_paths(rows.paths, i);
        const HitLanes hit = load_hits(rows.hits, i);
        const Mask is_hit = exists & (hit.primitive >= LanesI(0));
        const Mask is_miss = exists & (!is_hit);
        // In place: the rows written here have all been read.
        append_hits(rows.hits, sorted.hits, is_hit, hit);
        sorted.hits = append_paths(rows.paths, sorted.hits, is_hit, path);
        if (none(is_miss)) continue;
        const Packer packer(is_miss);
        const MissRows& m = rows.misses;
        const int at = sorted.misses;
        store3(m.dx, m.dy, m.dz, at, pack(packer, path.direction));
        store3(m.tr, m.tg, m.tb, at, pack(packer, path.throughput));
        store(m.pdf + at, packer(path.pdf));
        store(m.slot + at, pack(packer, path.slot));
        sorted.misses += count(is_miss);
    }
    return sorted;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
