// surface/thin_wall.h - light that passes a smooth wall without thickness in its own direction.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/layered_bsdf.h"

namespace obscura {

/// What a wall lets pass straight through, as seen from one side.
template <typename F>
struct StraightLight {
    Vec3<F> transmittance;
    F probability;  ///< with which a path should go that way, 0: the wall is none or is rough
};

inline namespace OBSCURA_ISA {

/// Takes transmission out of a smooth thin wall's lobes and returns it as what it is there: a lobe
/// without a density, whose one direction is that of the light. A wall is smooth whose lobes are as
/// narrow as any (min_ggx_alpha); one that is rougher keeps its blurred lobe.
///
/// In      wo: in the shading frame, wo.z > 0
/// In/Out  w: of layered_weights; the probabilities of its lobes then sum to 1 - probability
/// Source  KHR_materials_transmission: what the dielectric boundary does not reflect, times the
///         base colour; see layered_transmission, of which this is the limit
template <typename F>
OBSCURA_INLINE StraightLight<F> take_straight_light(const LayeredParams<F>& p,
                                                    const Vec3<F>& wo,
                                                    LayeredWeights<F>& w) {
    const F zero(0.0f);
    const F one(1.0f);
    const LayeredFresnel<F> fresnel = layered_fresnel(p, wo.z);
    const F passes = max(one - max_component(fresnel.dielectric), zero);
    const F through = w.transmitted * passes * w.below_coat * w.below_sheen;
    // Where nothing comes through, the lobe stays: worth nothing, but with its density.
    const auto smooth = (!p.solid) & (max(p.alpha.x, p.alpha.y) <= F(min_ggx_alpha)) &
                        (through * max_component(p.base_color) > zero) & (wo.z > zero);
    const F chance = w.p_facet * (one - facet_reflects(p, w, fresnel));
    const StraightLight<F> light{select(smooth, p.base_color * through, splat3(zero)),
                                 select(smooth, chance, zero)};
    w.p_facet = w.p_facet - light.probability;
    w.transmitted = select(smooth, zero, w.transmitted);
    return light;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
