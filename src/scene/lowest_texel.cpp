// scene/lowest_texel.cpp - looks through a texture for its least value.
// SPDX-License-Identifier: Apache-2.0
#include "scene/lowest_texel.h"

#include <algorithm>

namespace obscura {

float lowest_texel(const Scene& scene, int32_t texture, int channel) {
    if (texture < 0) return 1.0f;
    const TextureRow& row = scene.textures.rows[static_cast<size_t>(texture)];
    const uint32_t* texels = &scene.textures.texels[static_cast<size_t>(row.level_offset[0])];
    const size_t count = static_cast<size_t>(row.width) * static_cast<size_t>(row.height);
    uint32_t lowest = 255U;
    for (size_t i = 0; i < count && lowest > 0; ++i)
        lowest = std::min(lowest, (texels[i] >> (8 * channel)) & 255U);
    return static_cast<float>(lowest) / 255.0f;
}

}  // namespace obscura
