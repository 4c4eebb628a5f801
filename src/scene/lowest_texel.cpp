// scene/lowest_texel.cpp - looks through a texture for its least value.
// SPDX-License-Identifier: Apache-2.0
#include "scene/lowest_texel.h"

#include <algorithm>

namespace obscura {

float lowest_texel(const Scene& scene, int32_t texture, int channel) {
    if (texture < 0) return 1.0f;
    const TextureRow& row = scene.textures.rows[static_cast<size_t>(texture)];
    const auto first = static_cast<size_t>(row.level_offset[0]);
    const size_t count = static_cast<size_t>(row.width) * static_cast<size_t>(row.height);
    float lowest = 1.0f;
    for (size_t i = first; i < first + count && lowest > 0.0f; ++i)
        lowest = std::min(lowest, texel_channel(scene.textures, row, i, channel));
    return lowest;
}

}  // namespace obscura
