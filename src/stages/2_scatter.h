// stages/2_scatter.h - stage 2, inside bodies that scatter light: flights between surfaces.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/stages.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Copies the paths that hit something from within a scattering body to the walkers.
///
/// In      rows.paths, rows.hits: `count` rows after an intersection
/// Out     rows.walkers, rows.walker_hits, rows.row: packed. Returns how many.
int begin_scatter(const SceneView& scene, int count, const ScatterStart& rows);

/// One flight of every walker. Those that reach their surface go back to their row, with the light
/// that the way leaves; those that scatter before stay, packed, with a new ray to be asked.
///
/// In      flight.last: nobody may scatter once more; what would is lost
/// Out     rows.paths, rows.hits: of those that are done. Returns how many stay.
/// Source  random walk with chromatic extinction: see surface/scattering.h
int scatter(const SceneView& scene, const Flight& flight, int count, const ScatterRows& rows);

}  // namespace OBSCURA_ISA
}  // namespace obscura
