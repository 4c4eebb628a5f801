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

/// Length of a direction after the stretch that gives the facets slopes of width 1.
/// Smith's Lambda is (this / |cos| - 1) / 2, G1 is 2 |cos| / (|cos| + this).
template <typename F>
OBSCURA_INLINE F smith_length(const Vec3<F>& w, const GgxWidths<F>& alpha) {
    return sqrt(square(w.x * alpha.x) + square(w.y * alpha.y) + w.z * w.z);
}

/// Height-correlated masking and shadowing over 4 |cos_o cos_i|, the factor besides D and F.
///
/// In      length_o, length_i: smith_length of both directions; cosines >= 0
/// Source  Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT
///         3(2), 2014, eq. 99; glTF 2.0, Appendix B
template <typename F>
OBSCURA_INLINE F
smith_visibility(const F& cos_o, const F& length_o, const F& cos_i, const F& length_i) {
    return F(0.5f) / (cos_o * length_i + cos_i * length_o);
}

/// Weight of a sample from a visible microfacet: the masking and shadowing of both directions over
/// the masking of wo alone.
template <typename F>
OBSCURA_INLINE F
smith_shadowing(const F& cos_o, const F& length_o, const F& cos_i, const F& length_i) {
    return cos_i * (cos_o + length_o) / (cos_o * length_i + cos_i * length_o);
}

/// A microfacet normal as seen from wo.
///
/// In      turn: sine and cosine of the angle around the view direction; height: in [0, 1)
/// Source  Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps", HPG 2023
template <typename F>
OBSCURA_INLINE Vec3<F> visible_normal(const Vec3<F>& wo,
                                      const GgxWidths<F>& alpha,
                                      const SinCos<F>& turn,
                                      const F& height) {
    const Vec3<F> stretched = normalize(Vec3<F>{wo.x * alpha.x, wo.y * alpha.y, wo.z});
    const F z = (F(1.0f) - height) * (F(1.0f) + stretched.z) - stretched.z;
    const F radius = sqrt(max(F(1.0f) - z * z, F(0.0f)));
    const Vec3<F> cap{radius * turn.cos, radius * turn.sin, z};
    const Vec3<F> h = cap + stretched;
    return normalize(Vec3<F>{h.x * alpha.x, h.y * alpha.y, max(h.z, F(0.0f))});
}

template <typename F>
OBSCURA_INLINE Vec3<F> sample_visible_normal(const Vec3<F>& wo,
                                             const GgxWidths<F>& alpha,
                                             const Vec2<F>& u) {
    return visible_normal(wo, alpha, sin_cos_turn(u.x), u.y);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
