// gltf/materials/lights_cameras.h - places lights and cameras in world space.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/load.h"
#include "gltf/parse/node_graph.h"
#include "scene/scene.h"

#include <vector>

namespace obscura::gltf {

/// Fills Scene::lights (with Scene::info.light_names) and Scene::cameras. Scale does not change a
/// light or a camera: cameras are placed by a rotation and a translation.
///
/// In      lights: which are left out, and by how much the others are brighter than the file says;
///         scene: light_profiles are those of the document
/// Errors  65 E-CAM-MATRIX a camera's node has no direction
Result<void> add_lights_and_cameras(const Document& document,
                                    const std::vector<PlacedNode>& placed,
                                    const LightChoice& lights,
                                    Scene& scene,
                                    Log& log);

}  // namespace obscura::gltf
