// scene/texture_arena.h - all texels of a scene in one array, with mip chains.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/unset_array.h"
#include "scene/mapped_texels.h"
#include "surface/texture_record.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace obscura {

/// Texels of all textures and the table of where they are.
struct TextureArena {
    LargeArray<uint32_t> texels;  ///< at most 2^31 - 1; see TextureRecord
    /// Not null: the texels lie in files, and `texels` is empty.
    std::shared_ptr<MappedTexels> mapped = nullptr;
    std::vector<TextureRecord> records;
};

/// The texels, wherever they are.
std::span<const uint32_t> texels_of(const TextureArena& textures);

/// Valid as long as the arena stays as it is.
TextureView view_of(const TextureArena& textures);

/// A channel of one texel as it is stored, in [0, 1].
///
/// In      texel: index in the arena; channel: 0 to 3 for red to alpha
float texel_channel(const TextureArena& textures,
                    const TextureRecord& record,
                    size_t texel,
                    int channel);

/// Number of mip levels of an image: down to 1x1.
int mip_level_count(int width, int height);

/// Texels of the whole mip chain.
size_t mip_chain_texels(int width, int height);

/// Writes levels 1.. behind level 0, which is already at `base`: each texel is the area-weighted
/// mean of the texels it covers. If `srgb`, colour is averaged in linear light and weighted by
/// alpha, so that hidden colours of transparent texels do not bleed in. Else the texels are data,
/// which have no alpha in glTF: their four bytes are averaged independently.
void build_mip_chain(uint32_t* base, int width, int height, bool srgb);

/// The same for 16-bit texels, whose low bytes lie at `low`.
void build_wide_mip_chain(uint32_t* base, uint32_t* low, int width, int height, bool srgb);

}  // namespace obscura
