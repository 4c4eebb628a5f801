// surface/material.h - the glTF metallic-roughness material as plain 32-bit words.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace obscura {

/// One texture use in a material: which texture, which UV set, and KHR_texture_transform.
struct TextureSlot {
    int32_t texture = -1;  ///< index in TextureArena::records, -1: none
    int32_t uv_set = 0;    ///< TEXCOORD_n, below max_uv_sets
    /// Rows of the 2x3 matrix that maps mesh UV to texture UV.
    float uv_from_mesh[6] = {1, 0, 0, 0, 1, 0};
};

inline constexpr int max_uv_sets = 8;

enum MaterialFlag : uint32_t {
    material_alpha_mask = 1U << 0,   ///< alphaMode MASK: hit where alpha >= alpha_cutoff
    material_alpha_blend = 1U << 1,  ///< alphaMode BLEND: hit with probability alpha
    material_double_sided = 1U << 2,
    material_unlit = 1U << 3,  ///< not lit: base colour and emission are the radiance
    /// Base colour, metallic-roughness and normal texture have the same size, sampler and
    /// coordinates, so that one texel position serves all; absent ones share the coordinates
    material_textures_alike = 1U << 4,
    /// The boundary of a medium, which rays meet from inside too: only its fronts glow
    material_glows_in_front = 1U << 5,
};

/// Whether both sides glow, where there is emission.
inline bool glows_on_both_sides(uint32_t flags) {
    return (flags & (material_double_sided | material_glows_in_front)) == material_double_sided;
}

/// One glTF material. A table of these is read word by word by the shading lanes, so every member
/// is 32 bits wide and there is no padding.
///
/// To add a lobe: see surface/lobes/list.h.
struct Material {
    float base_color[4] = {1, 1, 1, 1};  ///< linear Rec.709 and alpha
    float metallic = 1;
    float roughness = 1;  ///< perceptual; GGX alpha is its square
    float normal_scale = 1;
    float alpha_cutoff = 0.5f;
    float emission[3] = {0, 0, 0};           ///< nits: emissiveFactor * emissiveStrength
    uint32_t flags = 0;                      ///< MaterialFlag bits
    int32_t layers = -1;                     ///< index in Scene::layers, -1: the core material only
    TextureSlot base_color_texture;          ///< sRGB, alpha linear
    TextureSlot metallic_roughness_texture;  ///< G roughness, B metallic
    TextureSlot normal_texture;              ///< tangent space, +Y up
    TextureSlot emissive_texture;            ///< sRGB
    TextureSlot occlusion_texture;           ///< R; only if the loader is asked for it
    float occlusion_strength = 1;
};

inline constexpr int core_slot_count = 5;

static_assert(sizeof(Material) == (13 + core_slot_count * 8 + 1) * 4,
              "gathered as 32-bit words: no padding");

}  // namespace obscura
