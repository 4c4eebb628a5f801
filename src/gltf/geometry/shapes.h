// gltf/geometry/shapes.h - the scene's analytic shapes become primitives and instances.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/geometry/meshes.h"

namespace obscura {

/// Adds what OBSCURA_shape and KHR_implicit_shapes place, behind add_meshes. A shape that its node
/// only moves and scales alike on all axes lies in world space; the others are instances.
///
/// Out     problems: E-SHAPE-SPHERES a particle's position is not finite or its radius not above
///         0, E-NODE-RANGE; 77 E-LIMIT-SPHERES more than 2^29; as read_floats
void add_shapes(const MeshSources& sources,
                MaterialTable& materials,
                Problems& problems,
                Scene& scene,
                Log& log);

}  // namespace obscura
