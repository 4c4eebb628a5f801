// scene/lowest_texel.cpp - the minimum of a texture's channel.
// SPDX-License-Identifier: Apache-2.0
#include "scene/lowest_texel.h"

#include <algorithm>

namespace obscura {

float lowest_texel(const Scene& scene, int32_t texture, int channel) {
    if (texture < 0) return 1.0f;
    const TextureRecord& record = scene.textures.records[static_cast<size_t>(texture)];
    const auto first = static_cast<size_t>(record.level_offset[0]);
    const size_t count = static_cast<size_t>(record.width) * static_cast<size_t>(record.height);
    float lowest = 1.0f;
    for (size_t i = first; i < first + count && lowest > 0.0f; ++i)
        lowest = std::min(lowest, texel_channel(scene.textures, record, i, channel));
    return lowest;
}

}  // namespace obscura
