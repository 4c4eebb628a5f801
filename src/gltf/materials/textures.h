// gltf/materials/textures.h - images of materials become texels in the arena.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/memory_budget.h"
#include "gltf/decode/buffers.h"
#include "gltf/materials/materials.h"
#include "scene/scene.h"
#include "scene/texel_file.h"

#include <filesystem>

namespace obscura::gltf {

/// One image as colour (1) or as data (0).
struct ImageUse {
    bool used = false;
    size_t base = 0;  ///< first texel in the arena
};

struct ImageState {
    std::array<ImageUse, 2> uses;  ///< by srgb
    int width = 0;
    int height = 0;
    bool wide = false;      ///< 16 bits a channel: a plane of low bytes lies behind the mip chain
    double glossiness = 0;  ///< GltfImage::glossiness that its texels were made with
    bool broken = false;    ///< magenta stands for it where it is colour, nothing where it is data

    bool used() const { return uses[0].used || uses[1].used; }
};

/// Decoded images, kept from one scene of an asset to the next.
struct TextureStore {
    std::vector<ImageState> images;  ///< empty: nothing was decoded yet
    std::vector<ImageInfo> infos;
    LargeArray<uint32_t> texels;                     ///< empty while a scene has them
    std::shared_ptr<MappedTexels> mapped = nullptr;  ///< as TextureArena has it
    std::vector<MemoryCharge> charges = {};          ///< of the texels, by image, wherever they are
};

/// What add_textures reads.
struct TextureSources {
    const Document& document;
    const BufferStore& buffers;
    std::filesystem::path folder;  ///< the asset's
    TextureStore& store;           ///< images that it holds are not decoded again
    bool measure_only = false;     ///< records are made, texels are not decoded
    const TextureLimit* limit = nullptr;
};

/// Fills Scene::textures and Scene::info.images, and turns the texture numbers in the slots of used
/// materials into records of the arena; slots of unused materials become empty.
///
/// An image that is used as colour and as data is stored twice, with different mip chains. Records
/// that differ only in their sampler share texels.
///
/// Out     problems: for each image that a drawn material uses 67 E-RES-MISSING, E-IMG-*;
///         65 E-URI-DATA, E-ACC-RANGE; 69 E-IMG-FEATURE; 77 E-IMG-LIMIT, E-URI-REFUSED; 33
///         E-IMG-MEMORY. Slots of colour then see magenta, those of data become empty. Images that
///         no drawn material uses only warn
/// Errors  77 E-LIMIT-TEXELS; 33 E-MEM; those of write_texel_file
Result<void> add_textures(const TextureSources& sources,
                          MaterialTable& materials,
                          Problems& problems,
                          Scene& scene,
                          Log& log);

}  // namespace obscura::gltf
