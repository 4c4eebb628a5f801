// gltf/materials/materials.h - the scene's materials: glTF's, the default, reduced copies.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document.h"
#include "scene/scene.h"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace obscura {

/// A texture slot of Material (core) or of MaterialLayers (layer).
struct SlotRow {
    const char* name;  ///< in glTF
    bool color;        ///< texels are sRGB-encoded colours, else data
    TextureSlot Material::*core;
    TextureSlot MaterialLayers::*layer;
};

/// All slots, in one order everywhere. To add a slot: append it here and in its struct.
inline constexpr size_t slot_count = core_slot_count + layer_slot_count;
extern const std::array<SlotRow, slot_count> slot_rows;

template <typename CoreRow, typename LayerRow>
auto* slot_of(size_t slot, CoreRow& material, LayerRow& layers) {
    const SlotRow& row = slot_rows[slot];
    return row.core != nullptr ? &(material.*row.core) : &(layers.*row.layer);
}

/// Rows as in Scene::materials while meshes are read; slots still hold glTF texture numbers.
struct MaterialTable {
    std::vector<Material> rows;
    std::vector<MaterialLayers> layers;  ///< one a row; defaults where it has none
    std::vector<char> layered;           ///< whether it has any
    std::vector<std::string> names;
    std::vector<int32_t> numbers;  ///< in glTF, -1: the default material
    std::vector<char> used;        ///< by a primitive that is drawn
    /// Row of (glTF material, bit mask of the slots taken away).
    std::map<std::pair<int, uint32_t>, int> reduced;
    /// Row of (row, whether it is lit) of points and lines.
    std::map<std::pair<int, bool>, int> strokes;
};

/// Row 0 is the default material, row m + 1 is glTF material m.
MaterialTable make_material_table(const Document& document);

/// A primitive's row of the material table.
struct MaterialChoice {
    int row = 0;
    std::string lost = {};  ///< "baseColorTexture (TEXCOORD_1)": slots taken away; mostly empty
    bool is_new = false;    ///< the first time that they are taken away
};

/// The row for a primitive that has `uv_sets` (bit n: TEXCOORD_n); -1 is no material. Slots whose
/// set is absent are taken away.
MaterialChoice material_row(MaterialTable& table, int material, uint32_t uv_sets);

/// Adds a row that is like another one in all but its values, and returns it. It is not used yet.
int add_copy(MaterialTable& table, int row, const Material& values, const MaterialLayers& layers);

/// What of points or lines decides how their material is seen.
struct StrokeLook {
    bool has_normals = false;
    uint32_t uv_sets = 0;  ///< bit n: TEXCOORD_n
};

/// The row for points or lines. Without normals they are not lit: their radiance is base colour
/// plus emission. With normals they are pieces of surface, without an inside, that are alike on
/// both sides.
/// Source  glTF 2.0, Point and Line Materials
MaterialChoice stroke_material_row(MaterialTable& table, int material, const StrokeLook& look);

/// "the material "Glass" needs ...", for messages about slots that were taken away.
std::string lost_slots_text(const MaterialTable& table, const MaterialChoice& choice);

/// Hands rows and names over to the scene, and layers to those rows that have any.
void move_materials(MaterialTable& table, Scene& scene);

}  // namespace obscura
