// stages/2_scatter_lights.h - stage 2, inside scattering media: next-event estimation.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/sampler.h"
#include "stages/column_lanes.h"
#include "stages/stages.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// What the random walks of one flight share.
struct WalkingBatch {
    const SceneView& scene;
    const BatchSettings& batch;
    const Flight& flight;
};

/// Pairs of random numbers of a bounce's first flight, beyond those of bounces: of its distance and
/// of the turn at its end.
enum class FlightPair : uint32_t { distance, turn, count };

inline constexpr uint32_t first_flight_pair = 0x464C5954U;

OBSCURA_INLINE Vec2<Lanes> flight_pair(const PathLanes& path,
                                       const Flight& flight,
                                       FlightPair use) {
    const uint32_t pair =
        first_flight_pair + static_cast<uint32_t>(use) +
        static_cast<uint32_t>(flight.bounce * static_cast<int>(FlightPair::count));
    return unit_pair<Lanes>(sobol_pair(path.key, path.sample, pair));
}

/// The way of paths through a medium, to their hits.
struct WayThrough {
    Mask exists;
    Lanes end_m;
    Vec3<Lanes> extinction, albedo;
    Vec3<Lanes> probability;  ///< with which the flight follows each channel
};

/// Where paths scatter inside a medium.
struct ScatteringPoint {
    Mask exists;
    Lanes distance_m;        ///< along the path
    Vec3<Lanes> throughput;  ///< of what arrives here by the phase function
    Lanes anisotropy;
    Vec2<Lanes> turn;       ///< uniform in [0, 1)^2, of the turn
    const PathLanes& path;  ///< as it arrives
    const WayThrough& way;  ///< exists where lights without size may be sampled all along
};

/// Lanes that sample lights where they scatter: in media like air, out of which shadow rays come,
/// and in the medium around the camera. In others, shadow rays would end at the boundary.
///
/// In   ior: of `medium`
Mask samples_lights(const WalkingBatch& walk, LanesI medium, Lanes ior);

/// Whether some light has a place but no size, and is apart from the tree.
bool has_point_lights(const SceneView& scene);

/// Samples one light at every point and appends the shadow rays to columns.shadows, of which there
/// are `count` so far. Near lights without size some of the paths turn towards them. Not inlined:
/// only few scenes need it.
///
/// A light without size is sampled all along the way instead, also of paths that do not scatter.
///
/// In/Out  next: the paths with their turns by the phase function
/// Source  Veach, PhD thesis, 1997, ch. 9: multiple importance sampling, with the turns, and of the
///         two ways to choose the place
void add_light_samples(const WalkingBatch& walk,
                       const ScatteringPoint& point,
                       const ScatterColumns& columns,
                       PathLanes& next,
                       int& count);

}  // namespace OBSCURA_ISA
}  // namespace obscura
