// gltf/geometry/strokes.h - glTF's points become spheres, its lines pieces of round curves.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/geometry/mesh_part.h"
#include "gltf/geometry/particles.h"
#include "scene/scene.h"

#include <string>

namespace obscura {

/// Adds a part of points or lines behind the scene's tables; material and node are the caller's.
/// Their radius is set later: see set_stroke_radii. Pieces of no length are left out.
///
/// In      part: in world space; where: for messages
/// In/Out  orders: as for append_spheres
/// Errors  77 E-LIMIT-SPHERES, E-LIMIT-VERTICES, E-LIMIT-ATTRIBUTES
Result<Primitive> append_strokes(Scene& scene,
                                 const MeshPart& part,
                                 const std::string& where,
                                 SphereOrders* orders = nullptr);

}  // namespace obscura
