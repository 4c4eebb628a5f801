// surface/material_layers.h - the parameters of glTF's material extensions, as 32-bit words.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/material.h"

namespace obscura {

/// Factors and textures of the KHR_materials extensions that go beyond the core material. Only
/// materials that use one have such a record (Material::layers); the defaults equal the core.
/// Read word by word by the shading lanes: every member is 32 bits wide, there is no padding.
///
/// To add a number or a texture of a lobe: append it here (numbers before slots; below are
/// layer_slot_count and the size); a member of MaterialFactors and its entry in
/// gltf/parse/material_factors.h and .cpp read it, gltf/parse/finish_material.cpp copies it and
/// converts a colour (in_space), slot_entries in gltf/materials/materials.cpp names a slot.
/// stages/3_layers.cpp makes LayeredParams of it. A new extension has an entry in
/// gltf/parse/extensions.cpp, its name in material_extensions of gltf/parse/tree_rules.cpp, and its
/// lines in docs/gltf.md: tests compare the three lists. The recipe for the lobe itself is in
/// surface/lobes/list.h.
struct MaterialLayers {
    float ior = 1.5f;  ///< KHR_materials_ior; 0: always reflects
    float specular = 1;
    float specular_color[3] = {1, 1, 1};
    float clearcoat = 0;
    float clearcoat_roughness = 0;  ///< perceptual
    float clearcoat_normal_scale = 1;
    float sheen_color[3] = {0, 0, 0};
    float sheen_roughness = 0;    ///< perceptual
    float anisotropy = 0;         ///< strength
    float anisotropy_cosine = 1;  ///< of the rotation from the tangent, counter-clockwise
    float anisotropy_sine = 0;
    float iridescence = 0;
    float iridescence_ior = 1.3f;
    /// For texel 0 and 1; without a texture: the second.
    float thin_film_thickness_nm[2] = {100, 400};
    float transmission = 0;
    float diffuse_transmission = 0;
    float diffuse_transmission_color[3] = {1, 1, 1};
    float attenuation[3] = {0, 0, 0};     ///< KHR_materials_volume: -ln(colour) / distance, 1/m
    float scatter_albedo[3] = {0, 0, 0};  ///< of one scattering
    float scatter_anisotropy = 0;
    float dispersion = 0;  ///< 20 / Abbe number
    /// 1 to max_media: number of the medium inside, greater for greater indices of refraction (see
    /// scene/media.h); 0: thin-walled.
    int32_t medium = 0;
    TextureSlot specular_texture;                    ///< A
    TextureSlot specular_color_texture;              ///< sRGB
    TextureSlot clearcoat_texture;                   ///< R
    TextureSlot clearcoat_roughness_texture;         ///< G
    TextureSlot clearcoat_normal_texture;            ///< tangent space
    TextureSlot sheen_color_texture;                 ///< sRGB
    TextureSlot sheen_roughness_texture;             ///< A
    TextureSlot anisotropy_texture;                  ///< RG direction, B strength
    TextureSlot iridescence_texture;                 ///< R
    TextureSlot thin_film_thickness_texture;         ///< G
    TextureSlot transmission_texture;                ///< R
    TextureSlot diffuse_transmission_texture;        ///< A
    TextureSlot diffuse_transmission_color_texture;  ///< sRGB
};

inline constexpr int layer_slot_count = 13;
inline constexpr int max_media = 255;

static_assert(sizeof(MaterialLayers) == (33 + layer_slot_count * 8) * 4, "no padding");

}  // namespace obscura
