// scene/touching_media.h - finds media whose boundaries may share faces.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <cstdint>
#include <vector>

namespace obscura {

/// By primitive: the number of the medium that it bounds if the world box of one of its instances
/// touches that of another boundary; else 0 (scene/media.h). Empty when there is no such primitive.
std::vector<int32_t> find_touching_media(const Scene& scene);

}  // namespace obscura
