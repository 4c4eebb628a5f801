// scene/alike_textures.cpp - finds materials whose textures share size, sampler and coordinates.
// SPDX-License-Identifier: Apache-2.0
#include "scene/alike_textures.h"

#include <algorithm>
#include <array>

namespace obscura {

namespace {

bool same_coordinates(const TextureSlot& a, const TextureSlot& b) {
    return a.uv_set == b.uv_set && std::equal(a.uv_from_mesh, a.uv_from_mesh + 6, b.uv_from_mesh);
}

/// True when equal coordinates give equal texel indices, counted from the start of each texture.
bool same_layout(const TextureRecord& a, const TextureRecord& b) {
    if (a.width != b.width || a.height != b.height || a.levels != b.levels) return false;
    if (((a.sampler ^ b.sampler) & ~sampler_srgb) != 0) return false;
    for (int level = 0; level < a.levels; ++level) {
        if (a.level_offset[level] - a.level_offset[0] != b.level_offset[level] - b.level_offset[0])
            return false;
    }
    return true;
}

void mark(const std::vector<TextureRecord>& records, Material& material) {
    const std::array<TextureSlot*, 3> slots = {&material.base_color_texture,
                                               &material.metallic_roughness_texture,
                                               &material.normal_texture};
    const auto first =
        std::find_if(slots.begin(), slots.end(), [](const auto* s) { return s->texture >= 0; });
    if (first == slots.end()) return;
    const TextureRecord& record = records[static_cast<size_t>((*first)->texture)];
    for (const TextureSlot* slot : slots) {
        if (slot->texture < 0) continue;
        if (!same_coordinates(*slot, **first)) return;
        if (!same_layout(records[static_cast<size_t>(slot->texture)], record)) return;
    }
    const TextureSlot coordinates = **first;
    for (TextureSlot* slot : slots) {
        const int32_t texture = slot->texture;
        *slot = coordinates;
        slot->texture = texture;
    }
    material.flags |= material_textures_alike;
}

}  // namespace

void mark_alike_textures(Scene& scene) {
    for (Material& material : scene.materials)
        mark(scene.textures.records, material);
}

}  // namespace obscura
