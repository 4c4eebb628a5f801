// gltf/parse/document_materials.cpp - reads images, samplers, textures and materials.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/document_materials.h"

#include "gltf/parse/finish_material.h"

#include <algorithm>
#include <optional>

namespace obscura::gltf {

namespace {

void read_texture_transform(DocumentReading& reading,
                            const ValueReader& info,
                            TextureFactors& out,
                            uint64_t& uv_set) {
    constexpr const char* name = "KHR_texture_transform";
    out.transformed = info.has_extension(name);
    if (!out.transformed) return;
    const ValueReader object = info.extension(name);
    for (const NumberEntry<TextureFactors>& entry : transform_entries)
        clamped_numbers(reading, object, entry.place, entry.numbers(out), entry.limits);
    if (object.has("texCoord")) uv_set = object.size("texCoord", 0);
}

/// Reads a textureInfo with its KHR_texture_transform; one that cannot be read has no texture.
void read_texture_info(DocumentReading& reading, const ValueReader& info, TextureFactors& out) {
    info.require("index");
    const int index = info.index("index", reading.model.textures.size(), "texture");
    uint64_t uv_set = info.size("texCoord", 0);
    read_texture_transform(reading, info, out, uv_set);
    if (reading.failed()) return;
    const GltfTexture& texture = reading.document.textures[static_cast<size_t>(index)];
    if (texture.image < 0) {
        reading.log.warn(reading.document.at(info.pointer()),
                         "the texture has no image that can be read; it is ignored");
        return;
    }
    if (uv_set >= max_uv_sets) {
        reading.far_uv_sets.emplace_back(info.pointer(), uv_set);
        return;
    }
    out.texture = index;
    out.uv_set = static_cast<int>(uv_set);
}

uint32_t read_flags(DocumentReading& reading, const ValueReader& object) {
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

/// The object of a material that holds the entries; nothing: its extension is absent.
std::optional<ValueReader> find_object(const ValueReader& material, const MaterialObject& object) {
    constexpr std::string_view extensions = "extensions/";
    const std::string_view place = object.place;
    if (place.empty()) return material;
    if (place.substr(0, extensions.size()) != extensions) return material.child(place);
    const std::string_view name = place.substr(extensions.size());
    return material.has_extension(name) ? std::optional(material.extension(name)) : std::nullopt;
}

void read_entry(DocumentReading& reading,
                const ValueReader& object,
                const MaterialEntry& entry,
                MaterialFactors& out) {
    const std::string_view key = entry.key;
    if (entry.numbers == nullptr) {
        TextureFactors& texture = out.*entry.texture;
        texture.given = object.has(key);
        if (texture.given) read_texture_info(reading, object.child(key), texture);
        return;
    }
    clamped_numbers(reading, object, key, entry.numbers(out), entry.limits);
}

/// False: the entry is skipped, whatever the file has there.
bool is_wanted(const DocumentReading& reading, const MaterialEntry& entry, bool unlit) {
    if (entry.texture == &MaterialFactors::occlusion_texture)
        return reading.document.reads_occlusion;
    return !unlit || (entry.object.extensions & extension_specular_glossiness) == 0;
}

MaterialFactors read_material_factors(DocumentReading& reading, const ValueReader& material) {
    MaterialFactors out;
    const bool unlit = material.has_extension("KHR_materials_unlit");
    out.occlusion_texture.given = material.has("occlusionTexture");
    const MaterialObject* latest = nullptr;
    std::optional<ValueReader> object;
    for (const MaterialEntry& entry : material_entries) {
        if (latest != &entry.object) object = find_object(material, entry.object);
        latest = &entry.object;
        if (!object || !is_wanted(reading, entry, unlit)) continue;
        out.extensions |= entry.object.extensions;
        read_entry(reading, *object, entry, out);
    }
    out.flags = read_flags(reading, material);
    return out;
}

// Core members are read as values, by the same functions as members of extensions.

using tinygltf::Value;

Value numbers_value(const std::vector<double>& numbers) {
    Value::Array out;
    for (const double number : numbers)
        out.emplace_back(number);
    return Value(std::move(out));
}

/// Adds a textureInfo where the material has one.
template <typename TextureInfo>
void add_texture(const char* key, const TextureInfo& info, Value::Object& out) {
    if (info.index < 0) return;
    Value::Object members;
    members.emplace("index", Value(info.index));
    members.emplace("texCoord", Value(info.texCoord));
    members.emplace("extensions", Value(info.extensions));
    if constexpr (requires { info.scale; }) members.emplace("scale", Value(info.scale));
    if constexpr (requires { info.strength; }) members.emplace("strength", Value(info.strength));
    out.emplace(key, Value(std::move(members)));
}

Value material_value(const tinygltf::Material& material) {
    const tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
    Value::Object inside;
    inside.emplace("baseColorFactor", numbers_value(pbr.baseColorFactor));
    inside.emplace("metallicFactor", Value(pbr.metallicFactor));
    inside.emplace("roughnessFactor", Value(pbr.roughnessFactor));
    add_texture("baseColorTexture", pbr.baseColorTexture, inside);
    add_texture("metallicRoughnessTexture", pbr.metallicRoughnessTexture, inside);
    Value::Object out;
    out.emplace("pbrMetallicRoughness", Value(std::move(inside)));
    out.emplace("emissiveFactor", numbers_value(material.emissiveFactor));
    add_texture("normalTexture", material.normalTexture, out);
    add_texture("emissiveTexture", material.emissiveTexture, out);
    add_texture("occlusionTexture", material.occlusionTexture, out);
    out.emplace("alphaCutoff", Value(material.alphaCutoff));
    out.emplace("alphaMode", Value(material.alphaMode));
    out.emplace("doubleSided", Value(material.doubleSided));
    out.emplace("extensions", Value(material.extensions));
    return Value(std::move(out));
}

}  // namespace

void read_images(DocumentReading& reading) {
    for (size_t i = 0; i < reading.model.images.size(); ++i) {
        const tinygltf::Image& image = reading.model.images[i];
        GltfImage& out = reading.document.images[i];
        out.name = image.name;
        out.mime = image.mimeType;
        if (out.name.empty() && out.uri && out.uri->rfind("data:", 0) != 0) out.name = *out.uri;
        out.name = name_or(out.name, "image", i);
    }
}

void read_samplers(DocumentReading& reading) {
    const auto read = [&](const tinygltf::Sampler& sampler, const ModelElement& place, size_t) {
        const auto choice = [&](const char* key, int value, std::initializer_list<int> accepted) {
            if (std::find(accepted.begin(), accepted.end(), value) != accepted.end()) return value;
            place.fault(key,
                        "E-DOC-SAMPLER",
                        std::to_string(value) + " is not one of the values that glTF lists");
            return value;
        };
        GltfSampler out;
        const int mag = sampler.magFilter < 0 ? out.mag_filter : sampler.magFilter;
        const int min = sampler.minFilter < 0 ? out.min_filter : sampler.minFilter;
        out.mag_filter = choice("magFilter", mag, {9728, 9729});
        out.min_filter = choice("minFilter", min, {9728, 9729, 9984, 9985, 9986, 9987});
        out.wrap_s = choice("wrapS", sampler.wrapS, {33071, 33648, 10497});
        out.wrap_t = choice("wrapT", sampler.wrapT, {33071, 33648, 10497});
        reading.document.samplers.push_back(out);
    };
    each_element(reading, "samplers", reading.model.samplers, read);
}

void read_textures(DocumentReading& reading) {
    constexpr const char* better_images[] = {"EXT_texture_webp", "KHR_texture_basisu"};
    const size_t image_count = reading.model.images.size();
    const auto read = [&](const tinygltf::Texture& texture, const ModelElement& place, size_t) {
        GltfTexture out;
        out.sampler = texture.sampler;
        out.image = texture.source;
        for (const char* extension : better_images) {
            if (!place.has_extension(extension)) continue;
            const int better = place.extension(extension).index("source", image_count, "image");
            if (better >= 0) out.image = better;
        }
        reading.document.textures.push_back(out);
    };
    each_element(reading, "textures", reading.model.textures, read);
}

void read_materials(DocumentReading& reading) {
    Document& document = reading.document;
    const auto read = [&](const tinygltf::Material& file, const ModelElement& place, size_t index) {
        const Value value = material_value(file);
        const ValueReader material(value, place.pointer(), reading.fault);
        const MaterialFactors factors = read_material_factors(reading, material);
        document.materials.push_back(finish_material(factors, document));
        document.materials.back().name = name_or(file.name, "material", index);
        document.material_factors.push_back(factors);
    };
    each_element(reading, "materials", reading.model.materials, read);
}

}  // namespace obscura::gltf
