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

namespace obscura::gltf {

/// A texture slot of Material (core) or of MaterialLayers (layer).
struct SlotEntry {
    const char* name;  ///< in glTF
    bool color;        ///< texels are sRGB-encoded colours, else data
    TextureSlot Material::*core;
    TextureSlot MaterialLayers::*layer;
};

/// All slots, in one order everywhere. To add a slot: append it here and in its struct.
inline constexpr size_t slot_count = core_slot_count + layer_slot_count;
extern const std::array<SlotEntry, slot_count> slot_entries;

template <typename Core, typename Layers>
auto* slot_of(size_t slot, Core& material, Layers& layers) {
    const SlotEntry& entry = slot_entries[slot];
    return entry.core != nullptr ? &(material.*entry.core) : &(layers.*entry.layer);
}

/// The future Scene::materials while meshes are read; slots still hold glTF texture numbers.
struct MaterialTable {
    std::vector<Material> records;
    std::vector<MaterialLayers> layers;  ///< one each; defaults where it has none
    std::vector<char> layered;           ///< whether it has any
    std::vector<std::string> names;
    std::vector<int32_t> numbers;  ///< in glTF, -1: the default material
    std::vector<char> used;        ///< by a primitive that is drawn
    /// Material of (glTF material, bit mask of the slots taken away).
    std::map<std::pair<int, uint32_t>, int> reduced;
    /// Material of (material, whether it is lit) of points and lines.
    std::map<std::pair<int, bool>, int> points_lines;
};

/// Material 0 is the default material, material m + 1 is glTF material m.
MaterialTable make_material_table(const Document& document);

/// The material chosen for a primitive.
struct MaterialChoice {
    int index = 0;
    std::string lost = {};  ///< "baseColorTexture (TEXCOORD_1)": slots taken away; mostly empty
    bool is_new = false;    ///< the first time that they are taken away
};

/// The material for a primitive that has `uv_sets` (bit n: TEXCOORD_n); -1 is no material. Slots
/// whose set is absent are taken away: such a material is a reduced copy.
MaterialChoice material_for_surface(MaterialTable& table, int material, uint32_t uv_sets);

/// Adds a copy of a material with other values, not in use yet; returns its index.
int add_copy(MaterialTable& table, int index, const Material& values, const MaterialLayers& layers);

/// Properties of points or lines on which their material depends.
struct PointsLinesShading {
    bool has_normals = false;
    uint32_t uv_sets = 0;  ///< bit n: TEXCOORD_n
};

/// The material for points or lines. Without normals they are unlit: their radiance is base colour
/// plus emission. With normals they are double-sided surfaces without an inside.
/// Source  glTF 2.0, Point and Line Materials
MaterialChoice material_for_points_lines(MaterialTable& table,
                                         int material,
                                         const PointsLinesShading& shading);

/// "the material "Glass" needs ...", for messages about slots that were taken away.
std::string lost_slots_text(const MaterialTable& table, const MaterialChoice& choice);

/// Moves materials and names into the scene, and the layers of those that have any.
void move_materials(MaterialTable& table, Scene& scene);

}  // namespace obscura::gltf
