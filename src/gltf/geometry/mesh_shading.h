// gltf/geometry/mesh_shading.h - checks a primitive's normals and tangents, or makes them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/geometry/mesh_primitive.h"

namespace obscura::gltf {

/// Makes normals unit (bad ones become the mean of their triangles') and makes or repairs the
/// tangents that the material needs.
void finish_shading(MeshPrimitive& primitive, const MaterialNeeds& needs);

}  // namespace obscura::gltf
