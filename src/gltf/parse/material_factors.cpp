// gltf/parse/material_factors.cpp - tables of where a glTF material has its numbers and textures.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/material_factors.h"

#include "gltf/parse/document.h"

namespace obscura::gltf {

namespace {

using M = MaterialFactors;

constexpr NumberLimits unit = {0, 1};

template <auto member>
constexpr MaterialEntry number(const MaterialObject& object,
                               const char* key,
                               NumberLimits limits = unit) {
    return {object, key, numbers_of<member, M>, limits, nullptr};
}

constexpr MaterialEntry texture(const MaterialObject& object,
                                const char* key,
                                TextureFactors M::*member) {
    return {object, key, nullptr, {}, member};
}

/// A number in a texture's object.
template <auto member, auto texture_member>
constexpr MaterialEntry inside(const MaterialObject& object,
                               const char* key,
                               NumberLimits limits = unit) {
    return {object, key, numbers_of<member, M>, limits, texture_member};
}

constexpr double largest = largest_material_factor;
constexpr NumberLimits any_positive = {0, largest};
constexpr NumberLimits normal_scales = {-1e4, 1e4};
constexpr NumberLimits angles_rad = {-1e6, 1e6};
constexpr NumberLimits thin_film_nm = {0, 1e6};
constexpr double max_anisotropy = 0.999;  // beyond, light would never turn

constexpr MaterialObject material = {""};
constexpr MaterialObject core = {"pbrMetallicRoughness"};
constexpr MaterialObject emission = {"extensions/KHR_materials_emissive_strength"};
constexpr MaterialObject anisotropy = {"extensions/KHR_materials_anisotropy", extension_layers};
constexpr MaterialObject clearcoat = {"extensions/KHR_materials_clearcoat", extension_layers};
constexpr MaterialObject diffuse_transmission = {"extensions/KHR_materials_diffuse_transmission",
                                                 extension_layers};
constexpr MaterialObject dispersion = {"extensions/KHR_materials_dispersion", extension_layers};
constexpr MaterialObject ior = {"extensions/KHR_materials_ior", extension_layers};
constexpr MaterialObject iridescence = {"extensions/KHR_materials_iridescence", extension_layers};
constexpr MaterialObject sheen = {"extensions/KHR_materials_sheen", extension_layers};
constexpr MaterialObject specular = {"extensions/KHR_materials_specular", extension_layers};
constexpr MaterialObject transmission = {"extensions/KHR_materials_transmission", extension_layers};
constexpr MaterialObject volume = {"extensions/KHR_materials_volume",
                                   extension_layers | extension_volume};
constexpr MaterialObject volume_scatter = {"extensions/KHR_materials_volume_scatter",
                                           extension_layers | extension_volume_scatter};
constexpr MaterialObject glossy = {"extensions/KHR_materials_pbrSpecularGlossiness",
                                   extension_specular_glossiness};

constexpr MaterialEntry entries[] = {
    number<&M::base_color>(core, "baseColorFactor"),
    number<&M::metallic>(core, "metallicFactor"),
    number<&M::roughness>(core, "roughnessFactor"),
    texture(core, "baseColorTexture", &M::base_color_texture),
    texture(core, "metallicRoughnessTexture", &M::metallic_roughness_texture),
    texture(material, "normalTexture", &M::normal_texture),
    inside<&M::normal_scale, &M::normal_texture>(material, "normalTexture/scale", normal_scales),
    number<&M::emission>(material, "emissiveFactor"),
    texture(material, "emissiveTexture", &M::emissive_texture),
    texture(material, "occlusionTexture", &M::occlusion_texture),
    inside<&M::occlusion_strength, &M::occlusion_texture>(material, "occlusionTexture/strength"),
    number<&M::alpha_cutoff>(material, "alphaCutoff", any_positive),
    number<&M::emissive_strength>(emission, "emissiveStrength", {0, brightest}),
    number<&M::anisotropy>(anisotropy, "anisotropyStrength"),
    number<&M::anisotropy_rotation>(anisotropy, "anisotropyRotation", angles_rad),
    texture(anisotropy, "anisotropyTexture", &M::anisotropy_texture),
    number<&M::clearcoat>(clearcoat, "clearcoatFactor"),
    number<&M::clearcoat_roughness>(clearcoat, "clearcoatRoughnessFactor"),
    texture(clearcoat, "clearcoatTexture", &M::clearcoat_texture),
    texture(clearcoat, "clearcoatRoughnessTexture", &M::clearcoat_roughness_texture),
    texture(clearcoat, "clearcoatNormalTexture", &M::clearcoat_normal_texture),
    inside<&M::clearcoat_normal_scale, &M::clearcoat_normal_texture>(
        clearcoat, "clearcoatNormalTexture/scale", normal_scales),
    number<&M::diffuse_transmission>(diffuse_transmission, "diffuseTransmissionFactor"),
    number<&M::diffuse_transmission_color>(diffuse_transmission, "diffuseTransmissionColorFactor"),
    texture(diffuse_transmission, "diffuseTransmissionTexture", &M::diffuse_transmission_texture),
    texture(diffuse_transmission,
            "diffuseTransmissionColorTexture",
            &M::diffuse_transmission_color_texture),
    number<&M::dispersion>(dispersion, "dispersion", {0, 1e3}),
    number<&M::ior>(ior, "ior", {0, 100}),
    number<&M::iridescence>(iridescence, "iridescenceFactor"),
    number<&M::iridescence_ior>(iridescence, "iridescenceIor", {1, 100}),
    number<&M::iridescence_thickness_min_nm>(
        iridescence, "iridescenceThicknessMinimum", thin_film_nm),
    number<&M::iridescence_thickness_max_nm>(
        iridescence, "iridescenceThicknessMaximum", thin_film_nm),
    texture(iridescence, "iridescenceTexture", &M::iridescence_texture),
    texture(iridescence, "iridescenceThicknessTexture", &M::iridescence_thickness_texture),
    number<&M::sheen_color>(sheen, "sheenColorFactor"),
    number<&M::sheen_roughness>(sheen, "sheenRoughnessFactor"),
    texture(sheen, "sheenColorTexture", &M::sheen_color_texture),
    texture(sheen, "sheenRoughnessTexture", &M::sheen_roughness_texture),
    number<&M::specular>(specular, "specularFactor"),
    number<&M::specular_color>(specular, "specularColorFactor", any_positive),
    texture(specular, "specularTexture", &M::specular_texture),
    texture(specular, "specularColorTexture", &M::specular_color_texture),
    number<&M::transmission>(transmission, "transmissionFactor"),
    texture(transmission, "transmissionTexture", &M::transmission_texture),
    number<&M::thickness>(volume, "thicknessFactor", any_positive),
    number<&M::attenuation_distance>(volume, "attenuationDistance", {1e-20, largest}),
    number<&M::attenuation_color>(volume, "attenuationColor"),
    number<&M::multiscatter_color>(volume_scatter, "multiscatterColor"),
    number<&M::scatter_anisotropy>(
        volume_scatter, "scatterAnisotropy", {-max_anisotropy, max_anisotropy}),
    number<&M::diffuse>(glossy, "diffuseFactor"),
    number<&M::glossy_specular>(glossy, "specularFactor"),
    number<&M::glossiness>(glossy, "glossinessFactor"),
    texture(glossy, "specularGlossinessTexture", &M::specular_glossiness_texture),
    texture(glossy, "diffuseTexture", &M::diffuse_texture),
};

constexpr NumberLimits uv_limits = {-1e6, 1e6};

constexpr NumberEntry<TextureFactors> texture_entries[] = {
    {"offset", numbers_of<&TextureFactors::offset>, uv_limits},
    {"scale", numbers_of<&TextureFactors::scale>, uv_limits},
    {"rotation", numbers_of<&TextureFactors::rotation>, uv_limits},
};

}  // namespace

const std::span<const MaterialEntry> material_entries = entries;
const std::span<const NumberEntry<TextureFactors>> transform_entries = texture_entries;

}  // namespace obscura::gltf
