// scene/thin_walls.h - finds materials that may transmit light without refraction.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <cstdint>
#include <vector>

namespace obscura {

/// By material: 1 where some point may be a smooth thin wall, see surface/thin_wall.h. Shading
/// decides for each point.
std::vector<uint8_t> find_thin_walls(const Scene& scene);

/// Whether some medium has the index of air, so that light passes its boundary straight.
bool has_media_like_air(const Scene& scene);

}  // namespace obscura
