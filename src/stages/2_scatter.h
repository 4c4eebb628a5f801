// stages/2_scatter.h - stage 2, inside scattering media: one flight of each random-walk path.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/stages.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Copies the paths that hit something from inside a scattering medium to the random-walk columns.
///
/// In      columns.paths, columns.hits: `count` paths after an intersection
int begin_scatter(const SceneView& scene, int count, const ScatterStart& columns);

/// One flight of every random-walk path. Paths that reach their surface are attenuated and written
/// back; paths that scatter first stay, packed, with a new ray to trace.
///
/// In      flight.last: paths that would scatter again end
/// Out     columns.paths, columns.hits: of the paths that reached a surface; columns.shadows: of
///         those that scattered, at most one per sample. Returns how many stay.
/// Source  random walk with chromatic extinction: see surface/scattering.h
ScatterCounts scatter(const SceneView& scene,
                      const BatchSettings& batch,
                      const Flight& flight,
                      int count,
                      const ScatterColumns& columns);

}  // namespace OBSCURA_ISA
}  // namespace obscura
