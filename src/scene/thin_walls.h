// scene/thin_walls.h - finds materials that may let light pass straight through.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <cstdint>
#include <vector>

namespace obscura {

/// 1 for every material that somewhere may be a smooth wall without thickness: see
/// surface/thin_wall.h. What it is at one point, shading finds out.
std::vector<uint8_t> find_thin_walls(const Scene& scene);

/// Whether light passes straight through the boundary of some body, as its index is that of air.
bool has_bodies_like_air(const Scene& scene);

}  // namespace obscura
