// shape/box.h - a box along the axes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shape/surface_point.h"

namespace obscura {
inline namespace OBSCURA_ISA {

template <typename F>
struct AlignedBox {
    Vec3<F> centre;
    Vec3<F> half;  ///< half edges
};

template <typename F>
OBSCURA_INLINE Roots<F> intersect_box(const AlignedBox<F>& box, const ShapeRay<F>& ray) {
    const NearRay<F> near = bring_near(ray, box.centre);
    const Span<F> x = slab(near.origin.x, near.direction.x, box.half.x);
    const Span<F> y = slab(near.origin.y, near.direction.y, box.half.y);
    const Span<F> z = slab(near.origin.z, near.direction.z, box.half.z);
    return on_ray(near, ends_of(overlap(overlap(x, y), z)));
}

/// Every face shows the whole texture: the four sides upright, +Y up; the top with +Z at its lower
/// edge, the bottom with -Z at its lower edge.
template <typename F>
OBSCURA_INLINE SurfacePoint<F> surface_of_box(const AlignedBox<F>& box, const Vec3<F>& near) {
    const F zero(0.0f);
    const Vec3<F> inside{
        abs(near.x) - box.half.x, abs(near.y) - box.half.y, abs(near.z) - box.half.z};
    const auto is_x = (inside.x >= inside.y) & (inside.x >= inside.z);
    const auto is_y = (!is_x) & (inside.y >= inside.z);
    const auto is_z = !(is_x | is_y);
    const F sx = select(near.x < zero, F(-1.0f), F(1.0f));
    const F sy = select(near.y < zero, F(-1.0f), F(1.0f));
    const F sz = select(near.z < zero, F(-1.0f), F(1.0f));
    SurfacePoint<F> out;
    out.normal = {select(is_x, sx, zero), select(is_y, sy, zero), select(is_z, sz, zero)};
    out.position = {select(is_x, sx * box.half.x, clamp(near.x, F(-box.half.x), box.half.x)),
                    select(is_y, sy * box.half.y, clamp(near.y, F(-box.half.y), box.half.y)),
                    select(is_z, sz * box.half.z, clamp(near.z, F(-box.half.z), box.half.z))};
    const Vec3<F> size = box.half + box.half;
    // The direction to the right, seen from outside: -Z on +X, +X on +Z and so on; +X on top and
    // bottom.
    const F right_x = select(is_z, sz, F(1.0f));
    const F right_z = F(-sx);
    out.dpdu = {select(is_x, zero, right_x * size.x), zero, select(is_x, right_z * size.z, zero)};
    out.dpdv = {zero, select(is_y, zero, F(-size.y)), select(is_y, sy * size.z, zero)};
    const Vec3<F> position{
        out.position.x / size.x, out.position.y / size.y, out.position.z / size.z};
    out.uv = {select(is_x, right_z * position.z, right_x * position.x) + F(0.5f),
              select(is_y, sy * position.z, F(-position.y)) + F(0.5f)};
    out.error = zero;
    return out;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
