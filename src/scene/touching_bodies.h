// scene/touching_bodies.h - finds the boundaries of bodies that may share faces with another one.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <cstdint>
#include <vector>

namespace obscura {

/// By primitive: the number of the medium that it bounds where the box around one of its places in
/// the world touches that of another boundary; else 0 (scene/media.h). Empty when there is no such
/// primitive.
std::vector<int32_t> find_touching_bodies(const Scene& scene);

}  // namespace obscura
