// tests/support/arena_images.h - textures with mip chains in a scene's arena, texel by texel.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/texture_arena.h"

#include <cstddef>
#include <cstdint>

namespace obscura::test {

/// Adds a square image with its mip chain and returns its record. texel(x, y): as in TextureRecord.
template <typename Texel>
int32_t add_image(TextureArena& arena, int side, uint32_t sampler, const Texel& texel) {
    const size_t start = arena.texels.size();
    arena.texels.resize(start + mip_chain_texels(side, side));
    uint32_t* base = arena.texels.data() + start;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x)
            base[static_cast<size_t>(y) * static_cast<size_t>(side) + static_cast<size_t>(x)] =
                texel(x, y);
    }
    build_mip_chain(base, side, side, (sampler & sampler_srgb) != 0);
    TextureRecord record;
    record.width = record.height = side;
    record.levels = mip_level_count(side, side);
    record.sampler = sampler;
    auto at = static_cast<int32_t>(start);
    for (int level = 0; level < record.levels; ++level) {
        record.level_offset[level] = at;
        at += (side >> level) * (side >> level);
    }
    arena.records.push_back(record);
    return static_cast<int32_t>(arena.records.size()) - 1;
}

}  // namespace obscura::test
