// gltf/geometry/shapes.h - the scene's analytic shapes become primitives and instances.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/geometry/meshes.h"

namespace obscura::gltf {

/// Appends the shapes of OBSCURA_shape and KHR_implicit_shapes, after add_meshes. A shape whose
/// node only translates and scales uniformly lies in world space; others are instances.
///
/// Out     problems: E-SHAPE-SPHERES a particle's position is not finite or its radius not above
///         0, E-NODE-RANGE; 77 E-LIMIT-SPHERES more than 2^29; as read_floats
void add_shapes(const MeshSources& sources,
                MaterialTable& materials,
                Problems& problems,
                Scene& scene,
                Log& log);

}  // namespace obscura::gltf
