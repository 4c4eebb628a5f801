// stages/4_walls.h - stage 4, where there are thin walls: shadow rays go on behind them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/stages.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Moves the rows that wait (`waits_at_wall`) together at the front of their columns, in order.
/// Returns how many.
int take_waiting(int count, const uint8_t* occluded, const ShadowRows& rows);

/// One step of the rays that wait: what meets nothing gives its light to its sample; what meets a
/// smooth thin wall goes on behind it, towards the same end, with what the wall lets pass; the rest
/// is blocked.
///
/// In      rows.hits: nearest hits of the rows, [0, count)
/// Out     rows.shadows: the rays that go on, packed. Returns how many.
int cross_walls(const SceneView& scene, const WallStep& step, int count, const WallRows& rows);

}  // namespace OBSCURA_ISA
}  // namespace obscura
