// gltf/materials.cpp - the scene's material rows: glTF's own, the default one, and reduced copies.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/materials.h"

namespace obscura {

namespace {

constexpr std::array<const char*, slot_count> slot_names = {
    "baseColorTexture", "metallicRoughnessTexture", "normalTexture", "emissiveTexture"};

}  // namespace

std::array<TextureSlot*, slot_count> slots_of(Material& material) {
    return {&material.base_color_texture,
            &material.metallic_roughness_texture,
            &material.normal_texture,
            &material.emissive_texture};
}

std::array<const TextureSlot*, slot_count> slots_of(const Material& material) {
    return {&material.base_color_texture,
            &material.metallic_roughness_texture,
            &material.normal_texture,
            &material.emissive_texture};
}

MaterialTable make_material_table(const Document& document) {
    MaterialTable table;
    table.rows.emplace_back();
    table.names.emplace_back("default material");
    table.numbers.push_back(-1);
    for (const GltfMaterial& material : document.materials) {
        table.rows.push_back(material.values);
        table.names.push_back(material.name);
        table.numbers.push_back(static_cast<int32_t>(table.numbers.size()) - 1);
    }
    table.used.assign(table.rows.size(), 0);
    return table;
}

int material_row(
    MaterialTable& table, const Document& document, int material, uint32_t uv_sets, Log& log) {
    const size_t own = static_cast<size_t>(material) + 1;
    uint32_t lost = 0;
    std::string lost_names;
    const auto slots = slots_of(std::as_const(table.rows[own]));
    for (size_t i = 0; i < slot_count; ++i) {
        if (slots[i]->texture < 0 || (uv_sets >> slots[i]->uv_set & 1U) != 0) continue;
        lost |= 1U << i;
        lost_names += std::string(lost_names.empty() ? "" : ", ") + slot_names[i] + " (TEXCOORD_" +
                      std::to_string(slots[i]->uv_set) + ")";
    }
    int row = static_cast<int>(own);
    if (lost != 0) {
        const auto [entry, is_new] =
            table.reduced.try_emplace({material, lost}, static_cast<int>(table.rows.size()));
        row = entry->second;
        if (is_new) {
            Material copy = table.rows[own];
            const auto copied = slots_of(copy);
            for (size_t i = 0; i < slot_count; ++i) {
                if ((lost >> i & 1U) != 0) *copied[i] = TextureSlot{};
            }
            table.rows.push_back(copy);
            table.names.push_back(table.names[own]);
            table.numbers.push_back(material);
            table.used.push_back(0);
            log.warn(document.at("materials", static_cast<size_t>(material)),
                     "primitives with \"" + table.names[own] +
                         "\" lack texture coordinates; there these textures are left out: " +
                         lost_names);
        }
    }
    table.used[static_cast<size_t>(row)] = 1;
    return row;
}

}  // namespace obscura
