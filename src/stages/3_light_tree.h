// stages/3_light_tree.h - next-event estimation with a light tree: the choice, and its probability.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/light_tree.h"
#include "stages/3_surface.h"
#include "stages/stages.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Where paths scatter, for the light tree: where rays to lights start, and the shading normal,
/// unless light from behind comes through too.
OBSCURA_INLINE LitPoint<Lanes> lit_point(const ShadingPoint& s) {
    const Vec3<Lanes> zero = splat3(Lanes(0.0f));
    Vec3<Lanes> normal = s.frame.normal;
    if (s.any_layers) normal = select(s.layers.lets_through, zero, normal);
    return {s.light_start, normal};
}

/// Remembers by sample index where paths scatter: there the tree tells, once they meet a light,
/// how probable its choice was.
///
/// In      columns: of LitPointRecord; null: there is no tree
OBSCURA_INLINE void note_lit_points(LitPointRecord* by_slot,
                                    Mask mask,
                                    LanesU slot,
                                    const LitPoint<Lanes>& at) {
    alignas(64) uint32_t slots[lane_count];
    alignas(64) float numbers[6][lane_count];
    store(slots, slot);
    const Lanes columns[6] = {
        at.position.x, at.position.y, at.position.z, at.normal.x, at.normal.y, at.normal.z};
    for (int k = 0; k < 6; ++k)
        store(numbers[k], columns[k]);
    for (uint32_t bits = mask_bits(mask); bits != 0; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        LitPointRecord& record = by_slot[slots[lane]];
        for (int k = 0; k < 3; ++k) {
            record.position[k] = numbers[k][lane];
            record.normal[k] = numbers[k + 3][lane];
        }
    }
}

/// The tree's choice for the lanes that have drawn the tree. Not inlined: most scenes have none.
///
/// In      random: that chose the tree
inline __attribute__((noinline)) void choose_from_tree(const LightTreeView& tree,
                                                       const LitPoint<Lanes>& at,
                                                       const LanesU& random,
                                                       const Mask& active,
                                                       LightTreeDraw<Lanes>& out) {
    out = draw_from_light_tree<Lanes>(tree, at, random, active);
    out.probability = out.probability * Lanes(tree.share);
}

/// Probability with which light sampling chose the lights that BSDF rays hit, at the points where
/// they scattered; 0 for those that are not in the tree. Not inlined, likewise.
///
/// In      light: number, see LightView; met: elsewhere the result means nothing
inline __attribute__((noinline)) Lanes probability_by_tree(const LightTreeView& tree,
                                                           const LitPointRecord* by_slot,
                                                           const LanesI& light,
                                                           const LanesU& slot,
                                                           const Mask& met) {
    const LanesI leaf = gather<Lanes>(tree.leaf_of_light, select(met, light, LanesI(0)));
    const Mask known = met & (leaf >= LanesI(0));
    const LanesI first =
        select(known, as_int(slot), LanesI(0)) * LanesI(words_per_record<LitPointRecord>);
    const auto read = [&](size_t offset) {
        const Four<Lanes> words = gather4<Lanes>(member_words<float>(by_slot, offset), first);
        return Vec3<Lanes>{words.x, words.y, words.z};
    };
    static_assert(words_per_record<LitPointRecord> == 8);
    const LitPoint<Lanes> at{read(offsetof(LitPointRecord, position)),
                             read(offsetof(LitPointRecord, normal))};
    const Lanes choice = light_tree_probability<Lanes>(tree, at, leaf, known);
    return select(known, choice * Lanes(tree.share), Lanes(0.0f));
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
