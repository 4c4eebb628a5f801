// gltf/geometry/splats.h - the Gaussian splats of the chosen scene become one field in world space.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/geometry/meshes.h"

namespace obscura::gltf {

/// Fills Scene::splats, its bounds and counts. Nodes may rotate, stretch and mirror splats; morph
/// targets and skins do not move them.
///
/// Out     problems: for each primitive what read_splat_primitive finds; E-NODE-RANGE a node moves
///         splats beyond 1e18
/// Errors  77 E-LIMIT-SPLATS
Result<void> add_splats(const MeshSources& sources, Problems& problems, Scene& scene, Log& log);

}  // namespace obscura::gltf
