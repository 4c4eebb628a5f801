// stages/3_walls.cpp - paths that go straight on through smooth thin walls.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_walls.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// Writes the ways of a group's paths: a slot has one path.
OBSCURA_INLINE void store_passed(const ShadeRows& rows, Mask mask, LanesU slot, Lanes way) {
    alignas(64) uint32_t slots[lane_count];
    alignas(64) float ways[lane_count];
    store(slots, slot);
    store(ways, way);
    for (uint32_t bits = mask_bits(mask); bits != 0; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        rows.passed[slots[lane]] = ways[lane];
    }
}

}  // namespace

PassedWalls pass_walls(const ShadeRows& rows,
                       int at,
                       const PathLanes& path,
                       const WallHit& hit,
                       LayeredPoint& layers) {
    const Lanes one(1.0f);
    const Lanes zero(0.0f);
    PassedWalls out{at, hit.scatters, one};
    Mask passes(false);
    if (hit.any_layers) {
        const StraightLight<Lanes> light = take_straight(layers, hit.wo);
        out.left = one - light.probability;
        const Mask lets_pass =
            hit.scatters & layers.layered & (max_component(light.transmittance) > zero);
        const Lanes chance = hit.only_passes ? one : light.probability;
        passes = lets_pass & (hit.choice < chance);
        out.others = hit.scatters & (!passes);
        if (any(passes)) {
            PathLanes next = path;
            next.origin = hit.start_beyond;
            next.throughput =
                path.throughput * light.transmittance * (one / select(passes, chance, one));
            next.cone_width = path.cone_width + path.cone_spread * hit.distance;
            out.next = append_paths(rows.next, at, passes, next);
        }
    }
    const Lanes way = passed_way(rows, hit.scatters, path) + hit.distance;
    store_passed(rows, hit.scatters, path.slot, select(passes, way, zero));
    return out;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
