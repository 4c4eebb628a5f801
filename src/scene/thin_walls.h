// scene/thin_walls.h - finds materials that may transmit light without refraction.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <cstdint>
#include <vector>

namespace obscura {

/// 1 for every material that somewhere may be a smooth thin wall: see
/// surface/lobes/straight_transmission.h. What it is at one point, shading finds out.
std::vector<uint8_t> find_thin_walls(const Scene& scene);

/// Whether some medium has the index of air, so that light passes its boundary straight.
bool has_media_like_air(const Scene& scene);

}  // namespace obscura
