// stages/3_scatter.h - evaluates and samples the BSDF of a shading point, core or layered.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/3_surface.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// The material's value for a direction, and the density with which sample_point chooses it.
OBSCURA_INLINE BsdfValue<Lanes> evaluate_point(const ShadingPoint& s,
                                               const Vec3<Lanes>& wo,
                                               const Vec3<Lanes>& wi) {
    const LayeredPoint& l = s.layers;
    if (s.any_layers && all(l.layered)) return evaluate_layers(l, wo, wi);
    const BsdfValue<Lanes> core = evaluate_bsdf(s.bsdf, s.lobes, wo, wi);
    if (!s.any_layers) return core;
    const BsdfValue<Lanes> layers = evaluate_layers(l, wo, wi);
    return {select(l.layered, layers.value_cos, core.value_cos),
            select(l.layered, layers.pdf, core.pdf)};
}

/// In   u: z is read where the surface lets light through
OBSCURA_INLINE BsdfSample<Lanes> sample_point(const ShadingPoint& s,
                                              const Vec3<Lanes>& wo,
                                              const Vec3<Lanes>& u) {
    const LayeredPoint& l = s.layers;
    if (s.any_layers && all(l.layered)) return sample_layers(l, wo, u);
    const BsdfSample<Lanes> core = sample_bsdf(s.bsdf, s.lobes, wo, Vec2<Lanes>{u.x, u.y});
    if (!s.any_layers) return core;
    const BsdfSample<Lanes> layers = sample_layers(l, wo, u);
    return {select(l.layered, layers.direction, core.direction),
            {select(l.layered, layers.at.value_cos, core.at.value_cos),
             select(l.layered, layers.at.pdf, core.at.pdf)},
            select(l.layered, layers.spread, core.spread)};
}

/// Whether a ray may leave in the direction wi. `reflected_side` tells on which side of the true
/// surface that is: the viewer's, or else the transmitted side. At materials with layers, the
/// shading normal must put wi on the same side.
OBSCURA_INLINE Mask may_leave(const ShadingPoint& s, Mask reflected_side, const Vec3<Lanes>& wi) {
    if (!s.any_layers) return reflected_side;
    const Mask through = s.layers.lets_through & (!reflected_side) & (wi.z < Lanes(0.0f));
    return (reflected_side & (wi.z > Lanes(0.0f))) | through;
}

/// The colour that multiplies a path's throughput where it is given a wavelength; else 1.
///
/// In   s: with layers; reflected_side: rays that leave on the viewer's side
OBSCURA_INLINE Vec3<Lanes> wavelength_tint(const ShadingPoint& s, Mask reflected_side) {
    return select(reflected_side & s.layers.reflects_white, splat3(Lanes(1.0f)), s.layers.tint);
}

/// The medium stack of a path that leaves. One that was given a wavelength keeps it.
OBSCURA_INLINE LanesU medium_stack_towards(const ShadingPoint& s,
                                           LanesU medium_stack,
                                           Mask reflected_side) {
    const LayeredPoint& l = s.layers;
    const LanesU given = select(reflected_side & l.reflects_white, LanesU(0U), l.wavelength);
    return select(reflected_side, medium_stack, l.boundary.transmitted_stack) | given;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
