// gltf/geometry/left_out_nodes.h - placings of meshes that are not drawn, with a warning.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document.h"
#include "scene/scene.h"

namespace obscura {

/// Removes instances in whose space rays would leave single precision (scene/ray_reach.h), stops
/// those that could not be followed while the shutter is open, removes copies that crowd on one
/// spot (scene/coincident_instances.h), and warns of each.
void leave_out_nodes(const Document& document, Scene& scene, Log& log);

}  // namespace obscura
