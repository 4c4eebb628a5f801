// scene/thin_walls.cpp - finds materials that may transmit light without refraction.
// SPDX-License-Identifier: Apache-2.0
#include "scene/thin_walls.h"

#include "scene/lowest_texel.h"
#include "surface/lobes/facet_transmission.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

bool is_like_air(float ior) {
    return std::fabs(ior - 1.0F) < min_refraction;
}

bool may_be_thin_wall(const Scene& scene, const Material& material) {
    if (material.layers < 0 || (material.flags & material_unlit) != 0) return false;
    const MaterialLayers& layers = scene.layers[static_cast<size_t>(material.layers)];
    if (layers.transmission <= 0.0f) return false;
    const int32_t texture = material.metallic_roughness_texture.texture;
    if (texture < 0 && material.metallic >= 1.0f) return false;
    if (layers.medium > 0) return is_like_air(layers.ior);  // which blurs nothing, however rough
    constexpr int green = 1;                                // holds roughness
    const float roughness = material.roughness * lowest_texel(scene, texture, green);
    return roughness * roughness * thin_wall_spread(layers.ior) <= min_ggx_alpha;
}

}  // namespace

std::vector<uint8_t> find_thin_walls(const Scene& scene) {
    std::vector<uint8_t> thin_walls(scene.materials.size(), 0);
    std::transform(
        scene.materials.begin(), scene.materials.end(), thin_walls.begin(), [&](const Material& m) {
            return static_cast<uint8_t>(may_be_thin_wall(scene, m) ? 1 : 0);
        });
    return thin_walls;
}

bool has_media_like_air(const Scene& scene) {
    return std::any_of(scene.media.begin(), scene.media.end(), [&](const Medium& medium) {
        return &medium != scene.media.data() && is_like_air(medium.ior);
    });
}

bool has_passable_boundaries(const Scene& scene) {
    return std::any_of(scene.materials.begin(), scene.materials.end(), [&](const Material& m) {
        if (m.layers < 0) return false;
        return scene.layers[static_cast<size_t>(m.layers)].medium > 0 && may_be_thin_wall(scene, m);
    });
}

}  // namespace obscura
