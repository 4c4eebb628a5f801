// gltf/materials/materials.cpp - the scene's materials: glTF's, the default, reduced copies.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/materials/materials.h"

#include "scene/media.h"

#include <algorithm>

namespace obscura::gltf {

const std::array<SlotEntry, slot_count> slot_entries = {{
    {"baseColorTexture", true, &Material::base_color_texture, nullptr},
    {"metallicRoughnessTexture", false, &Material::metallic_roughness_texture, nullptr},
    {"normalTexture", false, &Material::normal_texture, nullptr},
    {"emissiveTexture", true, &Material::emissive_texture, nullptr},
    {"occlusionTexture", false, &Material::occlusion_texture, nullptr},
    {"specularTexture", false, nullptr, &MaterialLayers::specular_texture},
    {"specularColorTexture", true, nullptr, &MaterialLayers::specular_color_texture},
    {"clearcoatTexture", false, nullptr, &MaterialLayers::clearcoat_texture},
    {"clearcoatRoughnessTexture", false, nullptr, &MaterialLayers::clearcoat_roughness_texture},
    {"clearcoatNormalTexture", false, nullptr, &MaterialLayers::clearcoat_normal_texture},
    {"sheenColorTexture", true, nullptr, &MaterialLayers::sheen_color_texture},
    {"sheenRoughnessTexture", false, nullptr, &MaterialLayers::sheen_roughness_texture},
    {"anisotropyTexture", false, nullptr, &MaterialLayers::anisotropy_texture},
    {"iridescenceTexture", false, nullptr, &MaterialLayers::iridescence_texture},
    {"iridescenceThicknessTexture", false, nullptr, &MaterialLayers::thin_film_thickness_texture},
    {"transmissionTexture", false, nullptr, &MaterialLayers::transmission_texture},
    {"diffuseTransmissionTexture", false, nullptr, &MaterialLayers::diffuse_transmission_texture},
    {"diffuseTransmissionColorTexture",
     true,
     nullptr,
     &MaterialLayers::diffuse_transmission_color_texture},
}};

MaterialTable make_material_table(const Document& document) {
    MaterialTable table;
    table.records.emplace_back();
    table.layers.emplace_back();
    table.layered.push_back(0);
    table.names.emplace_back("default material");
    table.numbers.push_back(-1);
    for (const GltfMaterial& material : document.materials) {
        table.records.push_back(material.values);
        // Unlit surfaces emit their base colour alone; points and lines become unlit later.
        const bool unlit = (material.values.flags & material_unlit) != 0;
        if (unlit) std::fill_n(table.records.back().emission, 3, 0.0f);
        table.layers.push_back(material.layers.value_or(MaterialLayers{}));
        table.layered.push_back(material.layers ? 1 : 0);
        table.names.push_back(material.name);
        table.numbers.push_back(static_cast<int32_t>(table.numbers.size()) - 1);
    }
    table.used.assign(table.records.size(), 0);
    return table;
}

int add_copy(MaterialTable& table,
             int index,
             const Material& values,
             const MaterialLayers& layers) {
    const auto from = static_cast<size_t>(index);
    table.records.push_back(values);
    table.layers.push_back(layers);
    table.layered.push_back(table.layered[from]);
    table.names.push_back(table.names[from]);
    table.numbers.push_back(table.numbers[from]);
    table.used.push_back(0);
    return static_cast<int>(table.records.size()) - 1;
}

MaterialChoice material_for_surface(MaterialTable& table, int material, uint32_t uv_sets) {
    const size_t own = static_cast<size_t>(material) + 1;
    MaterialChoice choice{static_cast<int>(own)};
    uint32_t lost = 0;
    for (size_t i = 0; i < slot_count; ++i) {
        const TextureSlot& slot = *slot_of(i, table.records[own], table.layers[own]);
        if (slot.texture < 0 || (uv_sets >> slot.uv_set & 1U) != 0) continue;
        lost |= 1U << i;
        choice.lost += std::string(choice.lost.empty() ? "" : ", ") + slot_entries[i].name +
                       " (TEXCOORD_" + std::to_string(slot.uv_set) + ")";
    }
    if (lost != 0) {
        const auto [entry, is_new] =
            table.reduced.try_emplace({material, lost}, static_cast<int>(table.records.size()));
        choice.index = entry->second;
        choice.is_new = is_new;
        if (is_new) {
            Material copy = table.records[own];
            MaterialLayers layers = table.layers[own];
            for (size_t i = 0; i < slot_count; ++i) {
                if ((lost >> i & 1U) != 0) *slot_of(i, copy, layers) = TextureSlot{};
            }
            add_copy(table, static_cast<int>(own), copy, layers);
        }
    }
    table.used[static_cast<size_t>(choice.index)] = 1;
    return choice;
}

MaterialChoice material_for_points_lines(MaterialTable& table,
                                         int material,
                                         const PointsLinesShading& shading) {
    MaterialChoice choice = material_for_surface(table, material, shading.uv_sets);
    const auto plain = static_cast<size_t>(choice.index);
    if ((table.records[plain].flags & material_unlit) != 0) return choice;
    const auto [entry, is_new] = table.points_lines.try_emplace(
        {choice.index, shading.has_normals}, static_cast<int>(table.records.size()));
    if (is_new) {
        Material values = table.records[plain];
        MaterialLayers layers = table.layers[plain];
        values.normal_texture = {};  // there are no tangents
        if (shading.has_normals) {
            values.flags |= material_double_sided;
            values.flags &= ~static_cast<uint32_t>(material_glows_in_front);
            layers.medium = 0;
        } else {
            values.flags |= material_unlit;
            values.metallic_roughness_texture = {};
        }
        const int index = add_copy(table, choice.index, values, layers);
        if (!shading.has_normals) table.layered[static_cast<size_t>(index)] = 0;
    }
    choice.index = entry->second;
    table.used[static_cast<size_t>(choice.index)] = 1;
    return choice;
}

std::string lost_slots_text(const MaterialTable& table, const MaterialChoice& choice) {
    return "the material \"" + table.names[static_cast<size_t>(choice.index)] +
           "\" needs texture coordinates that are absent: " + choice.lost;
}

void move_materials(MaterialTable& table, Scene& scene) {
    for (size_t index = 0; index < table.records.size(); ++index) {
        if (table.layered[index] == 0) continue;
        table.records[index].layers = static_cast<int32_t>(scene.layers.size());
        scene.layers.push_back(table.layers[index]);
    }
    number_media(scene);
    scene.materials = std::move(table.records);
    scene.material_names = std::move(table.names);
    scene.material_numbers = std::move(table.numbers);
}

}  // namespace obscura::gltf
