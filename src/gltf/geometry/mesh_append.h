// gltf/geometry/mesh_append.h - moves a primitive to the world, into the scene's arrays.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/geometry/mesh_part.h"
#include "scene/scene.h"

#include <string>

namespace obscura {

/// Moves a part to another space: positions by the matrix, normals by its inverse transpose,
/// tangents along; a mirror turns triangles round. False: a position is no longer in range.
bool bake_part(MeshPart& part, const Affined& world_from_mesh);

/// Sizes of a scene's arrays, in elements.
struct ArraySizes {
    size_t vertices = 0;
    size_t corners = 0;  ///< three a triangle
    size_t attribute_floats = 0;
};

/// The limit of 32-bit numbers that such arrays break ("E-LIMIT-VERTICES"); nullptr: none.
const char* broken_limit(const ArraySizes& sizes);

/// Adds a part behind the scene's arrays as a Primitive; material and node are the caller's.
///
/// Errors  77 E-LIMIT-*
Result<Primitive> append_part(Scene& scene, const MeshPart& part, const std::string& where);

}  // namespace obscura
