// render/enclosed_lights.h - finds lights that are shut up in the closed mesh of their own fixture.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render.h"

#include <cstdint>
#include <vector>

namespace obscura {

/// A light none of whose light leaves a surface.
struct EnclosedLight {
    size_t light = 0;   ///< row of Scene::lights
    int32_t node = -1;  ///< glTF node of the surface
};

/// Looks from every point and spot light, of up to 256, along 64 directions (a spot's are those of
/// its cone): it is enclosed when all of them end at opaque faces of one node, and the eye is
/// outside. A room that holds the eye too encloses nothing; nor does what the camera looks into,
/// over an edge or through a near wall (docs/gltf.md, single-sided materials).
std::vector<EnclosedLight> find_enclosed_lights(const PreparedScene& scene, const Vec3f& eye);

/// Says so in the log, with the names of the light and the node.
void warn_of_enclosed_lights(const PreparedScene& scene, const Vec3f& eye, Log& log);

}  // namespace obscura
