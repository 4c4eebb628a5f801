// stages/3_walls.cpp - paths that go straight on through smooth thin walls.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_walls.h"

namespace obscura {
inline namespace OBSCURA_ISA {

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
            // Light sampling does not see through a body's boundary: what lies behind counts whole.
            next.bodies = layers.boundary.beyond;
            next.pdf = select(layers.boundary.matched, zero, path.pdf);
            out.next = append_paths(rows.next, at, passes, next);
        }
    }
    const Lanes way = passed_way(rows, hit.scatters, path) + hit.distance;
    store_by_slot(rows.passed, hit.scatters, path.slot, select(passes, way, zero));
    return out;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
