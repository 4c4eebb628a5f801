// stages/3_thin_walls.h - paths that pass smooth thin walls without changing direction.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/3_layers.h"
#include "stages/stages.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// A group of hits at which some paths may go straight on.
struct ThinWallHit {
    Mask scatters;     ///< lanes whose path continues in some direction
    bool any_layers;   ///< false: no lane is at a thin wall
    bool only_passes;  ///< the last bounce is over: paths either pass straight on or end
    Lanes distance;    ///< of the hit
    Lanes choice;      ///< random number: sample_point's z, which it does not read here
    Vec3<Lanes> wo;    ///< in the shading frame
    Vec3<Lanes> transmitted_start;
};

/// The outcome of a group at smooth thin walls.
struct PassedThinWalls {
    int next = 0;  ///< size of columns.next, the rays written here included
    Mask others;   ///< lanes that continue in another direction
    Lanes left;    ///< probability of that: the probabilities of the layers' other lobes sum to it
};

/// Writes the rays that go straight on, and removes that light from the layers' lobes. Such a ray
/// keeps the density of the last scattering, and columns.distance_since_scattering the distance
/// from there. Not inlined into shading, as few scenes need it.
///
/// In      at: size of columns.next so far; columns.distance_since_scattering is not null; path: at
///         the hit
/// In/Out  layers: if hit.any_layers
PassedThinWalls pass_thin_walls(const ShadeColumns& columns,
                                int at,
                                const PathLanes& path,
                                const ThinWallHit& hit,
                                LayeredPoint& layers);

/// The distance since the paths' last scattering, up to the last thin wall, metres.
OBSCURA_INLINE Lanes read_distance_since_scattering(const ShadeColumns& columns,
                                                    Mask exists,
                                                    const PathLanes& path) {
    return gather<Lanes>(columns.distance_since_scattering,
                         select(exists, as_int(path.slot), LanesI(0)));
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
