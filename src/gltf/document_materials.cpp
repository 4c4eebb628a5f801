// gltf/document_materials.cpp - reads images, samplers, textures and materials.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/material_extensions.h"
#include "gltf/specular_glossiness.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

constexpr double largest_factor = 1e30;

/// KHR_texture_transform as a matrix: uv' = offset + rotation * scale * uv. A positive angle turns
/// the UV axes counter-clockwise as seen with v pointing down.
void read_texture_transform(DocumentReading& reading,
                            const JsonReader& info,
                            TextureSlot& slot,
                            uint64_t& uv_set) {
    constexpr const char* name = "KHR_texture_transform";
    if (!info.has_extension(name)) return;
    const JsonReader object = info.extension(name);
    const NumberRange range = {0, -1e6, 1e6};
    std::array<double, 2> offset = {0, 0};
    std::array<double, 2> scale = {1, 1};
    clamped_numbers(reading, object, "offset", offset, range);
    clamped_numbers(reading, object, "scale", scale, range);
    const double angle = clamped_number(reading, object, "rotation", range);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const double matrix[6] = {
        c * scale[0], s * scale[1], offset[0], -s * scale[0], c * scale[1], offset[1]};
    for (size_t i = 0; i < 6; ++i)
        slot.uv_from_mesh[i] = static_cast<float>(matrix[i]);
    if (object.has("texCoord")) uv_set = object.size("texCoord", 0);
}

uint32_t read_flags(DocumentReading& reading, const JsonReader& object) {
    uint32_t flags = 0;
    const std::string mode = object.text("alphaMode", "OPAQUE");
    if (mode == "MASK") {
        flags |= material_alpha_mask;
    } else if (mode == "BLEND") {
        flags |= material_alpha_blend;
    } else if (mode != "OPAQUE") {
        reading.log.warn(reading.document.at(object.pointer()),
                         "alphaMode \"" + mode + "\" is unknown; OPAQUE is used");
    }
    if (object.boolean("doubleSided", false)) flags |= material_double_sided;
    if (object.has_extension("KHR_materials_unlit")) flags |= material_unlit;
    return flags;
}

Material read_material_values(DocumentReading& reading, const JsonReader& object) {
    const NumberRange unit = {1, 0, 1};
    Material out;
    const JsonReader pbr = object.child("pbrMetallicRoughness");
    std::array<double, 4> base = {1, 1, 1, 1};
    clamped_numbers(reading, pbr, "baseColorFactor", base, unit);
    for (size_t i = 0; i < 4; ++i)
        out.base_color[i] = static_cast<float>(base[i]);
    out.metallic = static_cast<float>(clamped_number(reading, pbr, "metallicFactor", unit));
    out.roughness = static_cast<float>(clamped_number(reading, pbr, "roughnessFactor", unit));
    out.base_color_texture = read_texture_slot(reading, pbr, "baseColorTexture");
    out.metallic_roughness_texture = read_texture_slot(reading, pbr, "metallicRoughnessTexture");

    out.normal_texture = read_texture_slot(reading, object, "normalTexture");
    const JsonReader normal = object.child("normalTexture");
    out.normal_scale = static_cast<float>(clamped_number(reading, normal, "scale", {1, -1e4, 1e4}));

    std::array<double, 3> emission = {0, 0, 0};
    clamped_numbers(reading, object, "emissiveFactor", emission, unit);
    double strength = 1;
    constexpr const char* strength_name = "KHR_materials_emissive_strength";
    if (object.has_extension(strength_name)) {
        strength = clamped_number(
            reading, object.extension(strength_name), "emissiveStrength", {1, 0, brightest});
    }
    for (size_t i = 0; i < 3; ++i)
        out.emission[i] = static_cast<float>(emission[i] * strength);
    out.emissive_texture = read_texture_slot(reading, object, "emissiveTexture");

    if (reading.document.reads_occlusion) {
        out.occlusion_texture = read_texture_slot(reading, object, "occlusionTexture");
        const JsonReader occlusion = object.child("occlusionTexture");
        out.occlusion_strength =
            static_cast<float>(clamped_number(reading, occlusion, "strength", unit));
    }

    out.alpha_cutoff = static_cast<float>(
        clamped_number(reading, object, "alphaCutoff", {0.5, 0, largest_factor}));
    out.flags = read_flags(reading, object);
    return out;
}

}  // namespace

TextureSlot read_texture_slot(DocumentReading& reading,
                              const JsonReader& object,
                              std::string_view key) {
    TextureSlot slot;
    if (!object.has(key)) return slot;
    const JsonReader info = object.child(key);
    info.require("index");
    slot.texture = info.index("index", reading.root.count("textures"), "texture");
    uint64_t uv_set = info.size("texCoord", 0);
    read_texture_transform(reading, info, slot, uv_set);
    if (reading.root.failed()) return TextureSlot{};
    const GltfTexture& texture = reading.document.textures[static_cast<size_t>(slot.texture)];
    if (texture.image < 0) {
        reading.log.warn(reading.document.at(info.pointer()),
                         "the texture has no image that can be read; it is ignored");
        return TextureSlot{};
    }
    if (uv_set >= max_uv_sets) {
        reading.far_uv_sets.emplace_back(info.pointer(), uv_set);
        return TextureSlot{};
    }
    slot.uv_set = static_cast<int32_t>(uv_set);
    return slot;
}

void read_images(DocumentReading& reading) {
    const size_t view_count = reading.root.count("bufferViews");
    reading.root.each("images", [&](const JsonReader& image, size_t index) {
        GltfImage out;
        out.name = image.text("name");
        if (image.has("uri")) out.uri = image.text("uri");
        out.view = image.index("bufferView", view_count, "buffer view");
        out.mime = image.text("mimeType");
        if (out.uri.has_value() == (out.view >= 0)) {
            image.fault("", "E-DOC-IMAGE", "an image must have either a uri or a bufferView");
        }
        if (out.name.empty() && out.uri && out.uri->rfind("data:", 0) != 0) out.name = *out.uri;
        if (out.name.empty()) out.name = "image " + std::to_string(index);
        reading.document.images.push_back(std::move(out));
    });
}

void read_samplers(DocumentReading& reading) {
    reading.root.each("samplers", [&](const JsonReader& sampler, size_t) {
        const auto choice =
            [&](const char* key, int fallback, std::initializer_list<int> accepted) {
                const uint64_t value = sampler.size(key, static_cast<uint64_t>(fallback));
                for (const int option : accepted) {
                    if (value == static_cast<uint64_t>(option)) return option;
                }
                sampler.fault(key,
                              "E-DOC-SAMPLER",
                              std::to_string(value) + " is not one of the values that glTF lists");
                return fallback;
            };
        GltfSampler out;
        out.mag_filter = choice("magFilter", out.mag_filter, {9728, 9729});
        out.min_filter = choice("minFilter", out.min_filter, {9728, 9729, 9984, 9985, 9986, 9987});
        out.wrap_s = choice("wrapS", out.wrap_s, {33071, 33648, 10497});
        out.wrap_t = choice("wrapT", out.wrap_t, {33071, 33648, 10497});
        reading.document.samplers.push_back(out);
    });
}

void read_textures(DocumentReading& reading) {
    constexpr const char* better_images[] = {"EXT_texture_webp", "KHR_texture_basisu"};
    const size_t image_count = reading.root.count("images");
    const size_t sampler_count = reading.root.count("samplers");
    reading.root.each("textures", [&](const JsonReader& texture, size_t) {
        GltfTexture out;
        out.sampler = texture.index("sampler", sampler_count, "sampler");
        out.image = texture.index("source", image_count, "image");
        for (const char* extension : better_images) {
            if (!texture.has_extension(extension)) continue;
            const int better = texture.extension(extension).index("source", image_count, "image");
            if (better >= 0) out.image = better;
        }
        reading.document.textures.push_back(out);
    });
}

void read_materials(DocumentReading& reading) {
    reading.root.each("materials", [&](const JsonReader& material, size_t index) {
        GltfMaterial out;
        out.name = material.text("name");
        if (out.name.empty()) out.name = "material " + std::to_string(index);
        out.values = read_material_values(reading, material);
        out.layers = read_material_layers(reading, material);
        read_specular_glossiness(reading, material, out);
        // A body has an inside, and a camera in it must see where it ends.
        if (out.layers && out.layers->medium != 0) out.values.flags |= material_double_sided;
        reading.document.materials.push_back(std::move(out));
    });
}

}  // namespace obscura
