// gltf/parse/specular_glossiness.cpp - KHR_materials_pbrSpecularGlossiness as metal-roughness.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/specular_glossiness.h"

#include "gltf/parse/finish_material.h"

#include <algorithm>
#include <cmath>

namespace obscura::gltf {

namespace {

/// A texture whose image is a roughness copy of that of `texture`.
int add_roughness_texture(Document& document, int texture, double factor) {
    GltfTexture copy = document.textures[static_cast<size_t>(texture)];
    const auto same = [&](const GltfImage& image) {
        return image.glossiness == factor && image.glossiness_of == copy.image;
    };
    const auto found = std::find_if(document.images.begin(), document.images.end(), same);
    const auto number = static_cast<int>(found - document.images.begin());
    if (found == document.images.end()) {
        GltfImage image = document.images[static_cast<size_t>(copy.image)];
        image.name += ", as roughness";
        image.glossiness = factor;
        image.glossiness_of = copy.image;
        document.images.push_back(std::move(image));
    }
    copy.image = number;
    document.textures.push_back(copy);
    return static_cast<int>(document.textures.size()) - 1;
}

}  // namespace

void finish_specular_glossiness(const MaterialFactors& factors,
                                Document& document,
                                GltfMaterial& out) {
    if ((factors.extensions & extension_specular_glossiness) == 0) return;
    if ((factors.flags & material_unlit) != 0) return;
    const TextureSlot both = finish_slot(factors.specular_glossiness_texture);
    Material& values = out.values;
    for (size_t i = 0; i < 4; ++i)
        values.base_color[i] = static_cast<float>(factors.diffuse[i]);
    values.base_color_texture = finish_slot(factors.diffuse_texture);
    values.metallic = 0;
    values.roughness = static_cast<float>(1 - factors.glossiness);
    values.metallic_roughness_texture = both;
    if (both.texture >= 0) {
        values.roughness = 1;
        values.metallic_roughness_texture.texture =
            add_roughness_texture(document, both.texture, factors.glossiness);
    }
    MaterialLayers layers = out.layers.value_or(MaterialLayers{});
    layers.ior = 0;
    layers.specular = 1;
    layers.specular_texture = {};
    for (size_t i = 0; i < 3; ++i)
        layers.specular_color[i] = static_cast<float>(factors.glossy_specular[i]);
    layers.specular_color_texture = both;
    out.layers = layers;
}

void roughness_from_glossiness(std::span<uint32_t> texels,
                               std::span<uint32_t> low_bytes,
                               double factor) {
    const bool wide = !low_bytes.empty();
    const double most = wide ? 65535 : 255;
    const auto roughness = [&](uint32_t alpha) {
        return static_cast<uint32_t>(std::lround(most - factor * static_cast<double>(alpha)));
    };
    for (size_t i = 0; i < texels.size(); ++i) {
        const uint32_t high = texels[i] >> 24;
        if (wide) {
            const uint32_t code = roughness(high << 8 | low_bytes[i] >> 24);
            texels[i] = code >> 8 << 8 | 0xFF000000U;
            low_bytes[i] = (code & 255U) << 8 | 0xFF000000U;
        } else {
            texels[i] = roughness(high) << 8 | 0xFF000000U;
        }
    }
}

}  // namespace obscura::gltf
