// stages/4_transparent_shadows.h - stage 4: transparent shadow rays, which pass smooth thin walls.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/stages.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Attenuates shadow rays by the medium in which they are, up to their hits or lights.
///
/// In      columns.hits: [0, count), or no columns
void absorb_shadows(const SceneView& scene, int count, const ShadowMediaColumns& columns);

/// Packs the shadow rays that wait (`waits_at_thin_wall`) to the front of their columns, in order.
/// Returns how many.
int take_waiting(int count, const uint8_t* occluded, const ShadowColumns& columns);

/// One step of the shadow rays that wait. A ray that hits nothing adds its light to its sample. A
/// ray that hits a smooth thin wall continues behind it to the same end, attenuated. So does one
/// that has a medium stack, at a passable boundary (see Boundary). All others are blocked.
///
/// In      columns.hits: nearest hits of the rays, [0, count)
/// Out     columns.shadows: the rays that go on, packed. Returns how many.
int cross_thin_walls(const SceneView& scene,
                     const ThinWallStep& step,
                     int count,
                     const ThinWallColumns& columns);

}  // namespace OBSCURA_ISA
}  // namespace obscura
