// gltf/geometry/mesh_append.h - transforms a primitive and appends it to the scene's arrays.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/geometry/mesh_primitive.h"
#include "scene/scene.h"

#include <string>

namespace obscura::gltf {

/// Moves a primitive to another space: positions and tangents by the matrix, normals by its inverse
/// transpose; a mirror reverses the winding. False: a position is no longer in range.
bool bake_primitive(MeshPrimitive& primitive, const Affined& world_from_mesh);

/// Sizes of a scene's arrays, in elements.
struct ArraySizes {
    size_t vertices = 0;
    size_t corners = 0;  ///< three a triangle
    size_t attribute_floats = 0;
};

/// Id of the 32-bit limit that the arrays exceed ("E-LIMIT-VERTICES"); nullptr: none.
const char* broken_limit(const ArraySizes& sizes);

/// Appends a primitive to the scene's arrays; the caller sets material and node.
///
/// Errors  77 E-LIMIT-*
Result<Primitive> append_primitive(Scene& scene,
                                   const MeshPrimitive& primitive,
                                   const std::string& where);

}  // namespace obscura::gltf
