// stages/3_tables.h - how shading reads rows of the scene's tables.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/gather4.h"
#include "math/table_row.h"
#include "scene/scene.h"
#include "stages/rows.h"

namespace obscura {
inline namespace OBSCURA_ISA {

inline constexpr int primitive_words = static_cast<int>(sizeof(Primitive) / 4);
inline constexpr int instance_words = static_cast<int>(sizeof(Instance) / 4);
inline constexpr int motion_base_word = 17;
static_assert(offsetof(Primitive, motion_base) == motion_base_word * 4);
inline constexpr int instance_motion_word = 28;
static_assert(offsetof(Instance, motion) == instance_motion_word * 4);
inline constexpr int material_words = static_cast<int>(sizeof(Material) / 4);
inline constexpr int layers_words = static_cast<int>(sizeof(MaterialLayers) / 4);
inline constexpr int slot_words = static_cast<int>(sizeof(TextureSlot) / 4);

/// First word of a TextureSlot in a Material.
inline constexpr int base_color_slot = 13;
inline constexpr int metallic_roughness_slot = base_color_slot + slot_words;
inline constexpr int normal_slot = metallic_roughness_slot + slot_words;
inline constexpr int layers_word = 12;
static_assert(offsetof(Material, layers) == layers_word * 4);
inline constexpr int emissive_slot = normal_slot + slot_words;
inline constexpr int occlusion_slot = emissive_slot + slot_words;
inline constexpr int occlusion_strength_word = occlusion_slot + slot_words;
static_assert(offsetof(Material, occlusion_texture) == occlusion_slot * 4);
static_assert(offsetof(Material, occlusion_strength) == occlusion_strength_word * 4);
static_assert(offsetof(Material, base_color_texture) == base_color_slot * 4);
static_assert(offsetof(Material, emissive_texture) == emissive_slot * 4);

/// The scene's tables have a word of padding after the last triple.
OBSCURA_INLINE Vec3<Lanes> gather3(const float* base, LanesI word) {
    const Four<Lanes> words = gather4<Lanes>(base, word);
    return {words.x, words.y, words.z};
}

/// Four words at a corner of the hit triangles.
///
/// In  shared: all lanes want the same ones
OBSCURA_INLINE Four<Lanes> read_corner(const float* table, LanesI word, bool shared) {
    if (!shared) return gather4<Lanes>(table, word);
    const float* at = table + first_lane(word);
    return {Lanes(at[0]), Lanes(at[1]), Lanes(at[2]), Lanes(at[3])};
}

OBSCURA_INLINE Vec3<Lanes> read_corner3(const float* table, LanesI word, bool shared) {
    const Four<Lanes> words = read_corner(table, word, shared);
    return {words.x, words.y, words.z};
}

/// In  word: at least one more follows in the row
OBSCURA_INLINE Vec3<Lanes> read3(const TableRow<Lanes>& row, int word) {
    const Four<Lanes> words = row.four_numbers(word);
    return {words.x, words.y, words.z};
}

/// The instances of the hits; lanes in world space get the first.
OBSCURA_INLINE TableRow<Lanes> instance_row(const SceneView& scene, const HitLanes& hit) {
    return {scene.instances, max(hit.instance, LanesI(0)), instance_words};
}

/// Row-major 3x4 of an instance.
OBSCURA_INLINE Affine<Lanes> read_affine(const TableRow<Lanes>& row, int word) {
    Affine<Lanes> a;
    for (int r = 0; r < 3; ++r) {
        const Four<Lanes> words = row.four_numbers(word + r * 4);
        a.m[r][0] = words.x;
        a.m[r][1] = words.y;
        a.m[r][2] = words.z;
        a.m[r][3] = words.w;
    }
    return a;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
