// scene/thin_walls.h - finds materials that may transmit light without refraction.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <cstdint>
#include <vector>

namespace obscura {

/// 1 for every material that somewhere may be a smooth thin wall (see
/// surface/lobes/straight_transmission.h) or that bounds a medium like air. What it is at one
/// point, shading finds out.
std::vector<uint8_t> find_thin_walls(const Scene& scene);

/// Whether some medium has the index of air, so that light passes its boundary straight.
bool has_media_like_air(const Scene& scene);

/// Whether some material with such a medium inside may transmit light.
bool has_passable_boundaries(const Scene& scene);

}  // namespace obscura
