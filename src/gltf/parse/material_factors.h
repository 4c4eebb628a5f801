// gltf/parse/material_factors.h - a glTF material's numbers and textures as its file has them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/number_entry.h"
#include "surface/material.h"

#include <array>
#include <cstdint>
#include <span>

namespace obscura::gltf {

/// A textureInfo with its KHR_texture_transform.
struct TextureFactors {
    bool given = false;        ///< the material names a texture here
    int texture = -1;          ///< in Document::textures; -1: none that can be read
    int uv_set = 0;            ///< TEXCOORD_n
    bool transformed = false;  ///< the extension is there
    std::array<double, 2> offset = {0, 0};
    std::array<double, 2> scale = {1, 1};
    double rotation = 0;
};

/// Which extensions a material has, as far as their presence says something beyond their numbers.
enum MaterialExtension : uint32_t {
    extension_layers = 1U << 0,  ///< one of those that make MaterialLayers
    extension_volume = 1U << 1,
    extension_volume_scatter = 1U << 2,
    extension_specular_glossiness = 1U << 3,
};

inline constexpr double largest_material_factor = 1e30;

/// Numbers lie in their ranges; what several of them make together is not worked out yet
/// (gltf/parse/finish_material.h). The defaults are glTF's.
struct MaterialFactors {
    uint32_t flags = 0;  ///< MaterialFlag bits that the file asks for
    uint32_t extensions = 0;

    std::array<double, 4> base_color = {1, 1, 1, 1};
    double metallic = 1;
    double roughness = 1;
    double normal_scale = 1;
    double occlusion_strength = 1;
    std::array<double, 3> emission = {0, 0, 0};
    double emissive_strength = 1;
    double alpha_cutoff = 0.5;
    TextureFactors base_color_texture;
    TextureFactors metallic_roughness_texture;
    TextureFactors normal_texture;
    TextureFactors occlusion_texture;
    TextureFactors emissive_texture;

    double ior = 1.5;
    double specular = 1;
    std::array<double, 3> specular_color = {1, 1, 1};
    TextureFactors specular_texture;
    TextureFactors specular_color_texture;

    double clearcoat = 0;
    double clearcoat_roughness = 0;
    double clearcoat_normal_scale = 1;
    TextureFactors clearcoat_texture;
    TextureFactors clearcoat_roughness_texture;
    TextureFactors clearcoat_normal_texture;

    std::array<double, 3> sheen_color = {0, 0, 0};
    double sheen_roughness = 0;
    TextureFactors sheen_color_texture;
    TextureFactors sheen_roughness_texture;

    double anisotropy = 0;
    double anisotropy_rotation = 0;
    TextureFactors anisotropy_texture;

    double iridescence = 0;
    double iridescence_ior = 1.3;
    double iridescence_thickness_min_nm = 100;
    double iridescence_thickness_max_nm = 400;
    TextureFactors iridescence_texture;
    TextureFactors iridescence_thickness_texture;

    double transmission = 0;
    TextureFactors transmission_texture;
    double diffuse_transmission = 0;
    std::array<double, 3> diffuse_transmission_color = {1, 1, 1};
    TextureFactors diffuse_transmission_texture;
    TextureFactors diffuse_transmission_color_texture;

    double thickness = 0;
    double attenuation_distance = largest_material_factor;
    std::array<double, 3> attenuation_color = {1, 1, 1};
    std::array<double, 3> multiscatter_color = {0, 0, 0};
    double scatter_anisotropy = 0;
    double dispersion = 0;

    /// KHR_materials_pbrSpecularGlossiness, `specular` being KHR_materials_specular's
    std::array<double, 4> diffuse = {1, 1, 1, 1};
    std::array<double, 3> glossy_specular = {1, 1, 1};
    double glossiness = 1;
    TextureFactors diffuse_texture;
    TextureFactors specular_glossiness_texture;
};

/// An object of a glTF material.
struct MaterialObject {
    const char* place;        ///< from the material on, as in a JSON pointer; "": the material
    uint32_t extensions = 0;  ///< MaterialExtension bits that its presence sets
};

/// One member of MaterialFactors and where a glTF material has it. Reading and animating both use
/// these entries.
///
/// To add a number or a texture of a material: add its member above and its entry to
/// material_entries, and use it in gltf/parse/finish_material.cpp.
struct MaterialEntry {
    const MaterialObject& object;
    const char* key;  ///< of a number in a texture's object: "normalTexture/scale"
    std::span<double> (*numbers)(MaterialFactors&);  ///< nullptr: it is a texture
    NumberLimits limits;
    TextureFactors MaterialFactors::*texture;  ///< it itself, or the one that the number lies in
};

/// In the order in which they are read.
extern const std::span<const MaterialEntry> material_entries;

/// The numbers of KHR_texture_transform; places are in its object.
extern const std::span<const NumberEntry<TextureFactors>> transform_entries;

}  // namespace obscura::gltf
