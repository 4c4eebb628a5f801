// gltf/material_extensions.cpp - the material extensions of a glTF material become MaterialLayers.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/material_extensions.h"

#include "surface/scattering.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

constexpr NumberRange zero_to_one = {0, 0, 1};
constexpr NumberRange default_one = {1, 0, 1};
constexpr double largest_factor = 1e30;

/// One extension of one material, while it is read.
class LayerReader {
public:
    LayerReader(DocumentReading& reading, const JsonReader& object)
        : reading_(reading), object_(object) {}

    float number(const char* key, const NumberRange& range) const {
        return static_cast<float>(clamped_number(reading_, object_, key, range));
    }
    /// Three numbers; where the key is absent they stay as they are.
    void color(const char* key, float (&out)[3], const NumberRange& range) const {
        std::array<double, 3> values = {out[0], out[1], out[2]};
        clamped_numbers(reading_, object_, key, values, range);
        for (size_t i = 0; i < 3; ++i)
            out[i] = static_cast<float>(values[i]);
    }
    TextureSlot texture(const char* key) const { return read_texture_slot(reading_, object_, key); }
    float child_number(const char* child, const char* key, const NumberRange& range) const {
        return static_cast<float>(clamped_number(reading_, object_.child(child), key, range));
    }

private:
    DocumentReading& reading_;
    const JsonReader& object_;
};

void read_ior(const LayerReader& from, MaterialLayers& out) {
    out.ior = from.number("ior", {1.5, 0, 100});
    if (out.ior > 0.0F) out.ior = std::max(out.ior, 1.0F);
}

void read_specular(const LayerReader& from, MaterialLayers& out) {
    out.specular = from.number("specularFactor", default_one);
    from.color("specularColorFactor", out.specular_color, {1, 0, largest_factor});
    out.specular_texture = from.texture("specularTexture");
    out.specular_color_texture = from.texture("specularColorTexture");
}

void read_clearcoat(const LayerReader& from, MaterialLayers& out) {
    out.clearcoat = from.number("clearcoatFactor", zero_to_one);
    out.clearcoat_roughness = from.number("clearcoatRoughnessFactor", zero_to_one);
    out.clearcoat_texture = from.texture("clearcoatTexture");
    out.clearcoat_roughness_texture = from.texture("clearcoatRoughnessTexture");
    out.clearcoat_normal_texture = from.texture("clearcoatNormalTexture");
    out.clearcoat_normal_scale =
        from.child_number("clearcoatNormalTexture", "scale", {1, -1e4, 1e4});
}

void read_sheen(const LayerReader& from, MaterialLayers& out) {
    from.color("sheenColorFactor", out.sheen_color, zero_to_one);
    out.sheen_roughness = from.number("sheenRoughnessFactor", zero_to_one);
    out.sheen_color_texture = from.texture("sheenColorTexture");
    out.sheen_roughness_texture = from.texture("sheenRoughnessTexture");
}

void read_anisotropy(const LayerReader& from, MaterialLayers& out) {
    out.anisotropy = from.number("anisotropyStrength", zero_to_one);
    const double rotation = static_cast<double>(from.number("anisotropyRotation", {0, -1e6, 1e6}));
    out.anisotropy_cosine = static_cast<float>(std::cos(rotation));
    out.anisotropy_sine = static_cast<float>(std::sin(rotation));
    out.anisotropy_texture = from.texture("anisotropyTexture");
}

void read_iridescence(const LayerReader& from, MaterialLayers& out) {
    out.iridescence = from.number("iridescenceFactor", zero_to_one);
    out.iridescence_ior = from.number("iridescenceIor", {1.3, 1, 100});
    out.film_thickness_nm[0] = from.number("iridescenceThicknessMinimum", {100, 0, 1e6});
    out.film_thickness_nm[1] = from.number("iridescenceThicknessMaximum", {400, 0, 1e6});
    out.iridescence_texture = from.texture("iridescenceTexture");
    out.film_thickness_texture = from.texture("iridescenceThicknessTexture");
}

void read_transmission(const LayerReader& from, MaterialLayers& out) {
    out.transmission = from.number("transmissionFactor", zero_to_one);
    out.transmission_texture = from.texture("transmissionTexture");
}

void read_diffuse_transmission(const LayerReader& from, MaterialLayers& out) {
    out.diffuse_transmission = from.number("diffuseTransmissionFactor", zero_to_one);
    from.color("diffuseTransmissionColorFactor", out.diffuse_transmission_color, default_one);
    out.diffuse_transmission_texture = from.texture("diffuseTransmissionTexture");
    out.diffuse_transmission_color_texture = from.texture("diffuseTransmissionColorTexture");
}

/// A thickness above 0 says that the surface bounds a body; how thick it really is, the rays find
/// out. Numbers of media are given once all materials are known.
void read_volume(const LayerReader& from, MaterialLayers& out) {
    constexpr double darkest = 1e-6;  // attenuationColor 0 would be opaque at any distance
    out.medium = from.number("thicknessFactor", {0, 0, largest_factor}) > 0.0F ? 1 : 0;
    const double distance = static_cast<double>(
        from.number("attenuationDistance", {largest_factor, 1e-20, largest_factor}));
    float color[3] = {1, 1, 1};
    from.color("attenuationColor", color, default_one);
    for (size_t i = 0; i < 3; ++i) {
        const double sigma = -std::log(std::max(static_cast<double>(color[i]), darkest)) / distance;
        out.attenuation[i] = static_cast<float>(std::min(sigma, 1e20));
    }
}

void read_dispersion(const LayerReader& from, MaterialLayers& out) {
    out.dispersion = from.number("dispersion", {0, 0, 1e3});
}

void read_volume_scatter(const LayerReader& from, MaterialLayers& out) {
    float color[3] = {0, 0, 0};
    from.color("multiscatterColor", color, zero_to_one);
    for (size_t i = 0; i < 3; ++i) {
        out.scatter_albedo[i] =
            static_cast<float>(single_scatter_albedo(static_cast<double>(color[i])));
    }
    constexpr double most = 0.999;  // beyond, light would never turn
    out.scatter_anisotropy = from.number("scatterAnisotropy", {0, -most, most});
}

struct LayerRow {
    const char* extension;
    void (*read)(const LayerReader&, MaterialLayers&);
};

constexpr LayerRow layer_rows[] = {
    {"KHR_materials_anisotropy", read_anisotropy},
    {"KHR_materials_clearcoat", read_clearcoat},
    {"KHR_materials_diffuse_transmission", read_diffuse_transmission},
    {"KHR_materials_dispersion", read_dispersion},
    {"KHR_materials_ior", read_ior},
    {"KHR_materials_iridescence", read_iridescence},
    {"KHR_materials_sheen", read_sheen},
    {"KHR_materials_specular", read_specular},
    {"KHR_materials_transmission", read_transmission},
    {"KHR_materials_volume", read_volume},
    {"KHR_materials_volume_scatter", read_volume_scatter},
};

}  // namespace

std::optional<MaterialLayers> read_material_layers(DocumentReading& reading,
                                                   const JsonReader& material) {
    MaterialLayers out;
    bool found = false;
    for (const LayerRow& row : layer_rows) {
        if (!material.has_extension(row.extension)) continue;
        const JsonReader object = material.extension(row.extension);
        row.read({reading, object}, out);
        found = true;
    }
    if (out.transmission <= 0.0F && out.diffuse_transmission <= 0.0F) out.medium = 0;
    if (!found) return std::nullopt;
    return out;
}

}  // namespace obscura
