// stages/3_walls.h - paths that go straight on through smooth thin walls.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/3_layers.h"
#include "stages/stages.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// A group of hits at which some paths may go straight on.
struct WallHit {
    Mask scatters;     ///< lanes whose path goes on somehow
    bool any_layers;   ///< else no lane is at a wall
    bool only_passes;  ///< the path's last bounce is over: what may pass does, the rest ends
    Lanes distance;    ///< of the hit
    Lanes choice;    ///< random number: the z that sample_point takes, which it does not read here
    Vec3<Lanes> wo;  ///< in the shading frame
    Vec3<Lanes> start_beyond;
};

/// What became of a group at smooth thin walls.
struct PassedWalls {
    int next = 0;  ///< rows of the next paths
    Mask others;   ///< lanes that go on in another way
    Lanes left;    ///< probability that they did: the shares of the layers' other lobes sum to this
};

/// Writes the rays that go straight on, and takes that light out of the layers' lobes. Such a ray
/// is still the one that the last scattering chose: it keeps its density, and `rows.passed` keeps
/// the way that it has gone since. Apart from shading, which most scenes need without.
///
/// In      at: rows of rows.next so far; rows.passed is there; path: at the hit
/// In/Out  layers: where hit.any_layers
PassedWalls pass_walls(
    const ShadeRows& rows, int at, const PathLanes& path, const WallHit& hit, LayeredPoint& layers);

/// The way that paths have gone straight on since their last scattering, metres.
OBSCURA_INLINE Lanes passed_way(const ShadeRows& rows, Mask exists, const PathLanes& path) {
    return gather<Lanes>(rows.passed, select(exists, as_int(path.slot), LanesI(0)));
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
