// surface/ggx.h - the GGX microfacet distribution with two widths: value, masking, sampling.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/warp.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Widths along the frame's tangent and bitangent.
template <typename F>
using GgxWidths = Vec2<F>;

/// Source  Burley, "Physically-Based Shading at Disney", SIGGRAPH 2012 course, appendix B.2
template <typename F>
OBSCURA_INLINE F ggx_distribution(const Vec3<F>& h, const GgxWidths<F>& alpha) {
    const F t = square(h.x / alpha.x) + square(h.y / alpha.y) + h.z * h.z;
    return F(1.0f) / (F(pi_f) * alpha.x * alpha.y * t * t);
}

/// Smith's G1 is 2 |cos| divided by this. Directions below the surface count as above.
template <typename F>
OBSCURA_INLINE F smith_denominator(const Vec3<F>& w, const GgxWidths<F>& alpha) {
    return abs(w.z) + sqrt(square(w.x * alpha.x) + square(w.y * alpha.y) + w.z * w.z);
}

/// A microfacet normal as seen from wo.
/// Source  Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps", HPG 2023
template <typename F>
OBSCURA_INLINE Vec3<F> sample_visible_normal(const Vec3<F>& wo,
                                             const GgxWidths<F>& alpha,
                                             const Vec2<F>& u) {
    const Vec3<F> stretched = normalize(Vec3<F>{wo.x * alpha.x, wo.y * alpha.y, wo.z});
    const SinCos<F> turn = sin_cos_turn(u.x);
    const F z = (F(1.0f) - u.y) * (F(1.0f) + stretched.z) - stretched.z;
    const F radius = sqrt(max(F(1.0f) - z * z, F(0.0f)));
    const Vec3<F> cap{radius * turn.cos, radius * turn.sin, z};
    const Vec3<F> h = cap + stretched;
    return normalize(Vec3<F>{h.x * alpha.x, h.y * alpha.y, max(h.z, F(0.0f))});
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
