// gltf/parse/finish_material.cpp - makes a material's values from the numbers in the file.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/finish_material.h"

#include "gltf/parse/specular_glossiness.h"
#include "surface/scattering.h"

#include <algorithm>
#include <cmath>

namespace obscura::gltf {

namespace {

float single(double number) {
    return static_cast<float>(number);
}

template <size_t N>
void set_singles(const std::array<double, N>& numbers, float (&out)[N]) {
    std::transform(numbers.begin(), numbers.end(), out, single);
}

Material finish_core(const MaterialFactors& from, bool reads_occlusion) {
    Material out;
    set_singles(from.base_color, out.base_color);
    out.metallic = single(from.metallic);
    out.roughness = single(from.roughness);
    out.normal_scale = single(from.normal_scale);
    out.alpha_cutoff = single(from.alpha_cutoff);
    for (size_t i = 0; i < 3; ++i)
        out.emission[i] = single(from.emission[i] * from.emissive_strength);
    out.flags = from.flags;
    out.base_color_texture = finish_slot(from.base_color_texture);
    out.metallic_roughness_texture = finish_slot(from.metallic_roughness_texture);
    out.normal_texture = finish_slot(from.normal_texture);
    out.emissive_texture = finish_slot(from.emissive_texture);
    if (reads_occlusion) {
        out.occlusion_texture = finish_slot(from.occlusion_texture);
        out.occlusion_strength = single(from.occlusion_strength);
    }
    return out;
}

void finish_surface(const MaterialFactors& from, MaterialLayers& out) {
    out.ior = single(from.ior);
    if (out.ior > 0.0F) out.ior = std::max(out.ior, 1.0F);
    out.specular = single(from.specular);
    set_singles(from.specular_color, out.specular_color);
    out.specular_texture = finish_slot(from.specular_texture);
    out.specular_color_texture = finish_slot(from.specular_color_texture);

    const auto rotation = static_cast<double>(single(from.anisotropy_rotation));
    out.anisotropy = single(from.anisotropy);
    out.anisotropy_cosine = single(std::cos(rotation));
    out.anisotropy_sine = single(std::sin(rotation));
    out.anisotropy_texture = finish_slot(from.anisotropy_texture);

    out.iridescence = single(from.iridescence);
    out.iridescence_ior = single(from.iridescence_ior);
    out.thin_film_thickness_nm[0] = single(from.iridescence_thickness_min_nm);
    out.thin_film_thickness_nm[1] = single(from.iridescence_thickness_max_nm);
    out.iridescence_texture = finish_slot(from.iridescence_texture);
    out.thin_film_thickness_texture = finish_slot(from.iridescence_thickness_texture);
}

/// Coat, sheen and other layers above the base.
void finish_coverings(const MaterialFactors& from, MaterialLayers& out) {
    out.clearcoat = single(from.clearcoat);
    out.clearcoat_roughness = single(from.clearcoat_roughness);
    out.clearcoat_texture = finish_slot(from.clearcoat_texture);
    out.clearcoat_roughness_texture = finish_slot(from.clearcoat_roughness_texture);
    out.clearcoat_normal_texture = finish_slot(from.clearcoat_normal_texture);
    out.clearcoat_normal_scale = single(from.clearcoat_normal_scale);

    set_singles(from.sheen_color, out.sheen_color);
    out.sheen_roughness = single(from.sheen_roughness);
    out.sheen_color_texture = finish_slot(from.sheen_color_texture);
    out.sheen_roughness_texture = finish_slot(from.sheen_roughness_texture);
}

void finish_transmission(const MaterialFactors& from, MaterialLayers& out) {
    out.transmission = single(from.transmission);
    out.transmission_texture = finish_slot(from.transmission_texture);
    out.diffuse_transmission = single(from.diffuse_transmission);
    set_singles(from.diffuse_transmission_color, out.diffuse_transmission_color);
    out.diffuse_transmission_texture = finish_slot(from.diffuse_transmission_texture);
    out.diffuse_transmission_color_texture = finish_slot(from.diffuse_transmission_color_texture);
    out.dispersion = single(from.dispersion);
}

/// A thickness above 0 marks the boundary of a medium; the rays find the true thickness. Media are
/// numbered once all materials are known.
void finish_volume(const MaterialFactors& from, MaterialLayers& out) {
    constexpr double darkest = 1e-6;  // attenuationColor 0 would be opaque at any distance
    const bool lets_light_in = out.transmission > 0.0F || out.diffuse_transmission > 0.0F;
    out.medium = lets_light_in && single(from.thickness) > 0.0F ? 1 : 0;
    const auto distance = static_cast<double>(single(from.attenuation_distance));
    float color[3];
    set_singles(from.attenuation_color, color);
    for (size_t i = 0; i < 3; ++i) {
        const double sigma = -std::log(std::max(static_cast<double>(color[i]), darkest)) / distance;
        out.attenuation[i] = single(std::min(sigma, 1e20));
    }
}

void finish_scattering(const MaterialFactors& from, MaterialLayers& out) {
    float color[3];
    set_singles(from.multiscatter_color, color);
    for (size_t i = 0; i < 3; ++i)
        out.scatter_albedo[i] = single(single_scatter_albedo(static_cast<double>(color[i])));
    out.scatter_anisotropy = single(from.scatter_anisotropy);
}

std::optional<MaterialLayers> finish_layers(const MaterialFactors& from) {
    if ((from.extensions & extension_layers) == 0) return std::nullopt;
    MaterialLayers out;
    finish_surface(from, out);
    finish_coverings(from, out);
    finish_transmission(from, out);
    if ((from.extensions & extension_volume) != 0) finish_volume(from, out);
    if ((from.extensions & extension_volume_scatter) != 0) finish_scattering(from, out);
    return out;
}

template <size_t N>
void convert_color(const Matrix3& from_rec709, std::array<double, N>& color) {
    const Xyz converted = product(from_rec709, Xyz{color[0], color[1], color[2]});
    std::copy(converted.begin(), converted.end(), color.begin());
}

/// All colours of a material in the rendering space, before anything is computed from them.
std::optional<MaterialFactors> in_space(MaterialFactors factors, const Matrix3& from_rec709) {
    convert_color(from_rec709, factors.base_color);
    convert_color(from_rec709, factors.emission);
    convert_color(from_rec709, factors.specular_color);
    convert_color(from_rec709, factors.sheen_color);
    convert_color(from_rec709, factors.diffuse_transmission_color);
    convert_color(from_rec709, factors.attenuation_color);
    convert_color(from_rec709, factors.multiscatter_color);
    convert_color(from_rec709, factors.diffuse);
    convert_color(from_rec709, factors.glossy_specular);
    return factors;
}

/// Removes the copies that specular-glossiness materials added.
void drop_copies(Document& document) {
    const auto is_copy = [&](int image) {
        return image >= 0 && document.images[static_cast<size_t>(image)].glossiness_of >= 0;
    };
    while (!document.textures.empty() && is_copy(document.textures.back().image))
        document.textures.pop_back();
    while (!document.images.empty() && document.images.back().glossiness_of >= 0)
        document.images.pop_back();
}

}  // namespace

TextureSlot finish_slot(const TextureFactors& from) {
    TextureSlot slot;
    if (from.texture < 0) return slot;
    slot.texture = from.texture;
    slot.uv_set = from.uv_set;
    if (!from.transformed) return slot;
    const double c = std::cos(from.rotation);
    const double s = std::sin(from.rotation);
    const auto& [x, y] = from.scale;
    const std::array<double, 6> matrix = {
        c * x, s * y, from.offset[0], -s * x, c * y, from.offset[1]};
    set_singles(matrix, slot.uv_from_mesh);
    return slot;
}

GltfMaterial finish_material(const MaterialFactors& from, Document& document) {
    const std::optional<MaterialFactors> converted =
        document.from_rec709 ? in_space(from, *document.from_rec709) : std::nullopt;
    const MaterialFactors& factors = converted ? *converted : from;
    GltfMaterial out;
    out.values = finish_core(factors, document.reads_occlusion);
    out.layers = finish_layers(factors);
    finish_specular_glossiness(factors, document, out);
    // A solid has an inside, and a camera in it must see its far boundary.
    const bool is_single_sided = (out.values.flags & material_double_sided) == 0;
    if (out.layers && out.layers->medium != 0 && is_single_sided)
        out.values.flags |= material_double_sided | material_glows_in_front;
    return out;
}

void finish_materials(Document& document) {
    drop_copies(document);
    for (size_t i = 0; i < document.material_factors.size(); ++i) {
        std::string name = std::move(document.materials[i].name);
        document.materials[i] = finish_material(document.material_factors[i], document);
        document.materials[i].name = std::move(name);
    }
}

}  // namespace obscura::gltf
