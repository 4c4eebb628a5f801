// scene/thin_walls.cpp - finds materials that may let light pass straight through.
// SPDX-License-Identifier: Apache-2.0
#include "scene/thin_walls.h"

#include "surface/bsdf.h"

#include <algorithm>

namespace obscura {

namespace {

/// Least of a texture's green channel, which holds roughness; filtering never goes below. 1 where
/// there is no texture.
float lowest_green(const Scene& scene, int32_t texture) {
    if (texture < 0) return 1.0f;
    const TextureRow& row = scene.textures.rows[static_cast<size_t>(texture)];
    const uint32_t* texels = &scene.textures.texels[static_cast<size_t>(row.level_offset[0])];
    const size_t count = static_cast<size_t>(row.width) * static_cast<size_t>(row.height);
    uint32_t lowest = 255U;
    for (size_t i = 0; i < count && lowest > 0; ++i)
        lowest = std::min(lowest, (texels[i] >> 8) & 255U);
    return static_cast<float>(lowest) / 255.0f;
}

bool may_be_thin_wall(const Scene& scene, const Material& material) {
    if (material.layers < 0 || (material.flags & material_unlit) != 0) return false;
    const MaterialLayers& layers = scene.layers[static_cast<size_t>(material.layers)];
    if (layers.medium > 0 || layers.transmission <= 0.0f) return false;
    const int32_t texture = material.metallic_roughness_texture.texture;
    if (texture < 0 && material.metallic >= 1.0f) return false;
    const float roughness = material.roughness * lowest_green(scene, texture);
    return roughness * roughness <= min_ggx_alpha;
}

}  // namespace

std::vector<uint8_t> find_thin_walls(const Scene& scene) {
    std::vector<uint8_t> walls(scene.materials.size(), 0);
    std::transform(
        scene.materials.begin(), scene.materials.end(), walls.begin(), [&](const Material& m) {
            return static_cast<uint8_t>(may_be_thin_wall(scene, m) ? 1 : 0);
        });
    return walls;
}

}  // namespace obscura
