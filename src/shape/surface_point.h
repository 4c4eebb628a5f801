// shape/surface_point.h - position, normal, uv and derivatives at a point of a shape.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/warp.h"
#include "shape/roots.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// A point on a shape. Texture coordinates as in glTF: v grows downwards in the image.
template <typename F>
struct SurfacePoint {
    Vec3<F> position;  ///< refined: on the surface to within `error`
    Vec3<F> normal;    ///< unit, outwards
    Vec3<F> dpdu;      ///< derivative by u; never zero, tangent to the surface
    Vec3<F> dpdv;
    Vec2<F> uv;
    F error;  ///< bound of the distance to the surface along the normal, metres
};

template <typename F>
OBSCURA_INLINE void choose(SurfacePoint<F>& out, const MaskOf<F>& m, const SurfacePoint<F>& in) {
    out.position = select(m, in.position, out.position);
    out.normal = select(m, in.normal, out.normal);
    out.dpdu = select(m, in.dpdu, out.dpdu);
    out.dpdv = select(m, in.dpdv, out.dpdv);
    out.uv = {select(m, in.uv.x, out.uv.x), select(m, in.uv.y, out.uv.y)};
    out.error = select(m, in.error, out.error);
}

/// Relative rounding error in single precision of a point and of the formulas on it.
inline constexpr float surface_slack = 8.0f / 16777216.0f;

/// The azimuth of a point around the Y axis: +Z is the centre of a texture and +X to the right of
/// it, as on a globe that faces +Z.
template <typename F>
struct Azimuth {
    F radius;        ///< from the axis
    F sine, cosine;  ///< of the angle from +Z towards +X; on the axis itself 0 and 1
    F turn;          ///< angle in turns, in [0, 1]; +Z is 0.5
};

template <typename F>
OBSCURA_INLINE Azimuth<F> azimuth_of(const F& x, const F& z) {
    const F radius = sqrt(x * x + z * z);
    const auto off_axis = radius > F(0.0f);
    const F inverse = F(1.0f) / select(off_axis, radius, F(1.0f));
    const F sine = select(off_axis, x * inverse, F(0.0f));
    const F cosine = select(off_axis, z * inverse, F(1.0f));
    return {radius, sine, cosine, atan2(sine, cosine) * F(0.5f / pi_f) + F(0.5f)};
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
