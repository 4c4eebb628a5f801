// stages/3_thin_walls.cpp - paths that pass smooth thin walls without changing direction.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_thin_walls.h"

#include <cfloat>

namespace obscura {
inline namespace OBSCURA_ISA {

PassedThinWalls pass_thin_walls(const ShadeColumns& columns,
                                int at,
                                const PathLanes& path,
                                const ThinWallHit& hit,
                                LayeredPoint& layers) {
    const Lanes one(1.0f);
    const Lanes zero(0.0f);
    PassedThinWalls out{at, hit.scatters, one};
    Mask passes(false);
    Mask straight(false);
    if (hit.any_layers) {
        const StraightLight<Lanes> light = take_straight(layers, hit.wo);
        out.left = one - light.probability;
        const Mask lets_pass =
            hit.scatters & layers.layered & (max_component(light.transmittance) > zero);
        const Lanes chance = hit.only_passes ? one : light.probability;
        passes = lets_pass & (hit.choice < chance);
        out.others = hit.scatters & (!passes);
        straight = passes | (hit.scatters & layers.layered & is_passed_unseen(layers.boundary));
        if (any(passes)) {
            PathLanes next = path;
            next.origin = hit.transmitted_start;
            next.throughput =
                path.throughput * light.transmittance * (one / select(passes, chance, one));
            next.cone_width = path.cone_width + path.cone_spread * hit.distance;
            // Where light sampling does not see through a medium's boundary, what lies on the
            // transmitted side counts whole.
            const Boundary& boundary = layers.boundary;
            next.medium_stack = boundary.transmitted_stack;
            next.pdf = select(boundary.matched & (!boundary.passable), zero, path.pdf);
            out.next = append_paths(columns.next, at, passes, next);
        }
    }
    const Lanes path_length =
        read_distance_since_scattering(columns, hit.scatters, path) + hit.distance;
    store_by_slot(columns.distance_since_scattering,
                  hit.scatters,
                  path.slot,
                  select(straight, max(path_length, Lanes(FLT_MIN)), zero));
    return out;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
