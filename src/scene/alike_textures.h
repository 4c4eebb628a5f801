// scene/alike_textures.h - finds materials whose textures share size, sampler and coordinates.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

namespace obscura {

/// Sets material_textures_alike where it holds, and gives those materials' absent slots the
/// coordinates of the present ones. Changes speed, not images.
void mark_alike_textures(Scene& scene);

}  // namespace obscura
