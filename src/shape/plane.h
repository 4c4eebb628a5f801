// shape/plane.h - a plane or a rectangle in it, with the normal +Y.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shape/surface_point.h"

namespace obscura {

/// Half sizes from this value on mean an infinite plane.
inline constexpr float unbounded = 1.0e30f;

inline namespace OBSCURA_ISA {

template <typename F>
struct Plane {
    Vec3<F> centre;
    F half_x, half_z;
};

/// One root, t = (centre - R_o) . n / (R_d . n); a ray along the plane misses it.
template <typename F>
OBSCURA_INLINE Roots<F> intersect_plane(const Plane<F>& plane, const ShapeRay<F>& ray) {
    const NearRay<F> near = bring_near(ray, plane.centre);
    const F t = -near.origin.y / near.direction.y;
    const Vec3<F> p = point_at(near, t);
    const MaskOf<F> met =
        (abs(t) < F(no_limit)) & (abs(p.x) <= plane.half_x) & (abs(p.z) <= plane.half_z);
    return on_ray<F>(near, {{t, t}, {met, met}});
}

/// u grows along +X, v along +Z: seen from above, +Z is at the texture's lower edge. Along an
/// unbounded axis the texture repeats every metre.
template <typename F>
OBSCURA_INLINE SurfacePoint<F> surface_of_plane(const Plane<F>& plane, const Vec3<F>& near) {
    const auto infinite_x = plane.half_x >= F(unbounded);
    const auto infinite_z = plane.half_z >= F(unbounded);
    const F width = select(infinite_x, F(1.0f), plane.half_x + plane.half_x);
    const F depth = select(infinite_z, F(1.0f), plane.half_z + plane.half_z);
    const F zero(0.0f);
    SurfacePoint<F> out;
    out.position = {near.x, zero, near.z};
    out.normal = {zero, F(1.0f), zero};
    out.dpdu = {width, zero, zero};
    out.dpdv = {zero, zero, depth};
    out.uv = {near.x / width + select(infinite_x, zero, F(0.5f)),
              near.z / depth + select(infinite_z, zero, F(0.5f))};
    out.error = zero;
    return out;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
