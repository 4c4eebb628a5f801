// scene/alike_textures.h - finds materials whose textures can be looked up together.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

namespace obscura {

/// Sets material_textures_alike where it holds, and gives those materials' absent slots the
/// coordinates of the present ones. Changes speed, not pictures.
void mark_alike_textures(Scene& scene);

}  // namespace obscura
