// scene/lowest_texel.h - the minimum of a texture's channel.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <cstdint>

namespace obscura {

/// In      texture: index, or -1 for none; channel: 0 to 3 for red to alpha
/// Out     minimum of the finest level, in [0, 1]: filtering never goes below; 1 without a texture
float lowest_texel(const Scene& scene, int32_t texture, int channel);

}  // namespace obscura
