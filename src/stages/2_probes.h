// stages/2_probes.h - stage 2, where media touch: probe rays that find coincident faces.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/stages.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Writes a short probe ray through every hit on a medium that touches another one. It runs along
/// the normal because the next rays' start is offset along the normal.
///
/// Out     columns.probes, columns.path_index: packed. Returns how many.
int make_probes(const SceneView& scene, int count, const ProbeColumns& columns);

}  // namespace OBSCURA_ISA
}  // namespace obscura
