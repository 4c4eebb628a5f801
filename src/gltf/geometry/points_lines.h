// gltf/geometry/points_lines.h - glTF points become spheres, lines become round curves.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/geometry/mesh_primitive.h"
#include "gltf/geometry/particles.h"
#include "scene/scene.h"

#include <string>

namespace obscura::gltf {

/// Appends a primitive of points or lines to the scene; the caller sets material and node,
/// set_points_lines_radii the radius later. Segments of zero length are left out.
///
/// In      primitive: in world space; where: for messages
/// In/Out  orders: as for append_spheres
/// Errors  77 E-LIMIT-SPHERES, E-LIMIT-VERTICES, E-LIMIT-ATTRIBUTES
Result<Primitive> append_points_lines(Scene& scene,
                                      const MeshPrimitive& primitive,
                                      const std::string& where,
                                      SphereOrders* orders = nullptr);

}  // namespace obscura::gltf
