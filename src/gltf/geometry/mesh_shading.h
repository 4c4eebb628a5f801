// gltf/geometry/mesh_shading.h - a primitive's normals and tangents: checked or made.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/geometry/mesh_part.h"

namespace obscura {

/// Makes normals unit (bad ones become the mean of their triangles') and makes or repairs the
/// tangents that the material needs.
void finish_shading(MeshPart& part, const MaterialNeeds& needs);

}  // namespace obscura
