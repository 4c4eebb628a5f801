// stages/2_scatter_lights.h - stage 2, inside scattering media: next-event estimation.
// SPDX-License-Identifier: Apache-2.0
#pragma once

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

/// Where paths scatter inside a medium.
struct ScatteringPoint {
    Mask exists;
    Vec3<Lanes> position;
    Vec3<Lanes> throughput;  ///< of what arrives here by the phase function
    Lanes anisotropy;
    const PathLanes& path;  ///< as it arrives
};

/// Lanes that sample lights where they scatter: in media like air, out of which shadow rays come,
/// and in the medium around the camera. In others, shadow rays would end at the boundary.
///
/// In   ior: of `medium`
Mask samples_lights(const WalkingBatch& walk, LanesI medium, Lanes ior);

/// Samples one light at every point and appends the shadow rays to columns.shadows, of which there
/// are `count` so far. Not inlined: only few scenes need it.
///
/// Source  Veach, PhD thesis, 1997, ch. 9: multiple importance sampling, with the phase function
void add_light_samples(const WalkingBatch& walk,
                       const ScatteringPoint& point,
                       const ScatterColumns& columns,
                       int& count);

}  // namespace OBSCURA_ISA
}  // namespace obscura
