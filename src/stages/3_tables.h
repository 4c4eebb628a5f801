// stages/3_tables.h - gathers records of the scene's tables for the lanes of a group.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/gather4.h"
#include "math/table_record.h"
#include "scene/scene.h"
#include "stages/column_lanes.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Reads three words by a gather of four: the tables have a word of padding after the last triple.
OBSCURA_INLINE Vec3<Lanes> gather3(const float* base, LanesI word) {
    const Four<Lanes> words = gather4<Lanes>(base, word);
    return {words.x, words.y, words.z};
}

/// Four words at a corner of the hit triangles.
///
/// In  shared: all lanes read the same words
OBSCURA_INLINE Four<Lanes> read_corner(const float* table, LanesI word, bool shared) {
    if (!shared) return gather4<Lanes>(table, word);
    const float* at = table + first_lane(word);
    return {Lanes(at[0]), Lanes(at[1]), Lanes(at[2]), Lanes(at[3])};
}

OBSCURA_INLINE Vec3<Lanes> read_corner3(const float* table, LanesI word, bool shared) {
    const Four<Lanes> words = read_corner(table, word, shared);
    return {words.x, words.y, words.z};
}

/// The instances of the hits; lanes in world space get the first.
OBSCURA_INLINE TableRecord<Lanes, Instance> instance_record(const SceneView& scene,
                                                            const HitLanes& hit) {
    return {scene.instances, max(hit.instance, LanesI(0))};
}

/// Row-major 3x4 of an instance.
template <auto... member, typename Record>
OBSCURA_INLINE Affine<Lanes> read_affine(const TableRecord<Lanes, Record>& record) {
    Affine<Lanes> a;
    for (int r = 0; r < 3; ++r) {
        const Four<Lanes> words = record.template four_numbers<member..., &Affinef::m>(r * 4);
        a.m[r][0] = words.x;
        a.m[r][1] = words.y;
        a.m[r][2] = words.z;
        a.m[r][3] = words.w;
    }
    return a;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
