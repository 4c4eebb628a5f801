// surface/lobes/straight_transmission.h - light straight through smooth thin walls.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/lobes/list.h"

namespace obscura {

/// The light that goes straight through a thin wall, as seen from one side.
template <typename F>
struct StraightLight {
    Vec3<F> transmittance;
    F probability;  ///< with which a path should go straight on; 0: no thin wall, or a rough one
};

inline namespace OBSCURA_ISA {

/// Takes transmission out of a smooth thin wall's lobes and returns it as what it is there: a lobe
/// without a density, whose one direction is that of the light. A thin wall is smooth where what
/// passes is spread as little as anything (min_ggx_alpha), as at an index of 1; where it is spread
/// more, the blurred lobe stays.
///
/// In      wo: in the shading frame, wo.z > 0
/// In/Out  w: of layered_weights; the probabilities of its lobes then sum to 1 - probability
/// Source  KHR_materials_transmission: what the dielectric boundary does not reflect, times the
///         base colour; see FacetTransmission, of which this is the limit
template <typename F>
OBSCURA_INLINE StraightLight<F> take_straight_light(const LayeredParams<F>& p,
                                                    const Vec3<F>& wo,
                                                    LayeredWeights<F>& w) {
    const F zero(0.0f);
    const F one(1.0f);
    const F through = w.transmitted * w.below_coat * w.below_sheen;
    // Where nothing comes through, the lobe stays: worth nothing, but with its density.
    const auto smooth = (!p.solid) & is_smooth(w.through_alpha) &
                        (through * max_component(p.base_color) > zero) & (w.reflects < one) &
                        (wo.z > zero);
    const F chance = w.p_facet * (one - w.reflects);
    const StraightLight<F> light{select(smooth, p.base_color * through, splat3(zero)),
                                 select(smooth, chance, zero)};
    w.p_facet = w.p_facet - light.probability;
    w.transmitted = select(smooth, zero, w.transmitted);
    w.through_factor = select(smooth, zero, w.through_factor);
    w.reflects = select(smooth, one, w.reflects);
    w.facetwise = w.facetwise & (!smooth);
    return light;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
