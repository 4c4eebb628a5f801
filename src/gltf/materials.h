// gltf/materials.h - the scene's material rows: glTF's own, the default one, and reduced copies.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/document.h"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace obscura {

/// The four slots of a material, in one order everywhere.
///
/// To add a slot: append it here and in Material, and say in slot_is_color what its texels are.
inline constexpr size_t slot_count = 4;
std::array<TextureSlot*, slot_count> slots_of(Material& material);
std::array<const TextureSlot*, slot_count> slots_of(const Material& material);

/// True where texels are sRGB-encoded colours, false where they are data.
constexpr bool slot_is_color(size_t slot) {
    return slot == 0 || slot == 3;
}

/// Rows as in Scene::materials while meshes are read; slots still hold glTF texture numbers.
struct MaterialTable {
    std::vector<Material> rows;
    std::vector<std::string> names;
    std::vector<int32_t> numbers;  ///< in glTF, -1: the default material
    std::vector<char> used;        ///< by a primitive that is drawn
    /// Row of (glTF material, bit mask of the slots taken away).
    std::map<std::pair<int, uint32_t>, int> reduced;
};

/// Row 0 is the default material, row m + 1 is glTF material m.
MaterialTable make_material_table(const Document& document);

/// The row for a primitive that has `uv_sets` (bit n: TEXCOORD_n); -1 is no material. Slots whose
/// set is absent are taken away, with one warning for each combination.
int material_row(
    MaterialTable& table, const Document& document, int material, uint32_t uv_sets, Log& log);

}  // namespace obscura
