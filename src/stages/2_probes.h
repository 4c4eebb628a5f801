// stages/2_probes.h - stage 2, where bodies touch: rays that look for faces in the same place.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/stages.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Writes a short ray through every hit on a body that touches another one: along the normal, for
/// on which sides of the faces around it the next rays start is decided along the normal.
///
/// Out     rows.probes, rows.row: packed. Returns how many.
int make_probes(const SceneView& scene, int count, const ProbeRows& rows);

}  // namespace OBSCURA_ISA
}  // namespace obscura
