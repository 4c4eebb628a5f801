// render/enclosed_lights.h - finds lights that their own fixture's closed mesh blocks.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render.h"

#include <cstdint>
#include <vector>

namespace obscura {

/// A light that one surface encloses.
struct EnclosedLight {
    size_t light = 0;   ///< index in Scene::lights
    int32_t node = -1;  ///< glTF node of the surface
};

/// Traces 64 directions from every point and spot light, at most 256 lights; a spot's directions
/// fill its cone. A light is enclosed if all rays end at opaque faces of one node and the eye is
/// outside. Rooms that hold the eye do not count, nor do objects that the camera looks into, over
/// an edge or through a culled back face (docs/gltf.md, single-sided materials).
std::vector<EnclosedLight> find_enclosed_lights(const PreparedScene& scene, const Vec3f& eye);

/// Logs a warning for each, with the names of the light and the node.
void warn_of_enclosed_lights(const PreparedScene& scene, const Vec3f& eye, Log& log);

}  // namespace obscura
