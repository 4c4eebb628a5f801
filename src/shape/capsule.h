// shape/capsule.h - the hull of two spheres on the Y axis.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shape/frustum.h"
#include "shape/sphere.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Radii may differ, but neither sphere may contain the other: |top - bottom| < 2 half_height.
template <typename F>
struct Capsule {
    Vec3<F> centre;
    F half_height;  ///< half the distance between the spheres' centres
    F bottom, top;  ///< radii at -half_height and +half_height
};

/// The cone that touches both spheres, between the circles in which it touches them.
template <typename F>
struct CapsuleSide {
    F sine, cosine;  ///< of the cone's opening: a sphere's normal there is (cosine, sine)
    F low, high;     ///< heights of the circles
    ConeSide<F> cone;
};

template <typename F>
OBSCURA_INLINE CapsuleSide<F> capsule_side(const Capsule<F>& c) {
    CapsuleSide<F> side;
    side.sine = (c.bottom - c.top) / (c.half_height + c.half_height);
    side.cosine = sqrt(max((F(1.0f) - side.sine) * (F(1.0f) + side.sine), F(1e-12f)));
    side.low = c.bottom * side.sine - c.half_height;
    side.high = c.top * side.sine + c.half_height;
    side.cone = {(c.top + c.bottom) * F(0.5f) / side.cosine, -(side.sine / side.cosine)};
    return side;
}

/// The roots are the first entry into and the last exit from the three parts: their union is
/// convex.
template <typename F>
OBSCURA_INLINE Roots<F> intersect_capsule(const Capsule<F>& capsule, const ShapeRay<F>& ray) {
    const NearRay<F> near = bring_near(ray, capsule.centre);
    const CapsuleSide<F> side = capsule_side(capsule);
    const F middle = (side.low + side.high) * F(0.5f);
    const F half = (side.high - side.low) * F(0.5f);
    const Span<F> between = slab(F(near.origin.y - middle), near.direction.y, half);
    const Span<F> parts[3] = {span_in_sphere(near, F(-capsule.half_height), capsule.bottom),
                              span_in_sphere(near, capsule.half_height, capsule.top),
                              overlap(between, span_in_cone(near, side.cone))};
    Span<F> all{F(no_limit), F(-no_limit)};
    for (const Span<F>& part : parts) {
        const auto met = part.low <= part.high;
        all.low = select(met, min(all.low, part.low), all.low);
        all.high = select(met, max(all.high, part.high), all.high);
    }
    return on_ray(near, ends_of(all));
}

/// u goes once around +Y (see Azimuth), v along the outline from the top to the bottom, equal
/// lengths for equal steps.
template <typename F>
OBSCURA_INLINE SurfacePoint<F> surface_of_capsule(const Capsule<F>& c, const Vec3<F>& near) {
    const CapsuleSide<F> side = capsule_side(c);
    const Azimuth<F> around = azimuth_of(near.x, near.z);
    SurfacePoint<F> out = surface_of_cone_side(side.cone, near, around);
    // Along the outline the normal's angle grows from 0 (up) to `bend` on the top sphere, stays on
    // the cone, and grows to pi on the bottom sphere.
    const F bend = atan2(side.cosine, side.sine);
    const F slant = (side.high - side.low) / side.cosine;
    const F length_top = c.top * bend;
    const F whole = length_top + slant + c.bottom * (F(pi_f) - bend);
    out.uv.y = (length_top + (side.high - near.y) / side.cosine) / whole;
    out.dpdv = out.dpdv * (whole * side.cosine);
    // A point belongs to a sphere if it lies above or below the circles where the cone touches.
    const auto above = near.y > side.high;
    const auto below = near.y < side.low;
    const auto round = above | below;
    if (any(round)) {
        const F offset = select(above, c.half_height, F(-c.half_height));
        const Sphere<F> end_cap{{F(0.0f), offset, F(0.0f)},
                                max(select(above, c.top, c.bottom), F(1e-30f))};
        SurfacePoint<F> cap = surface_of_sphere(end_cap, {near.x, near.y - offset, near.z});
        const F angle = cap.uv.y * F(pi_f);
        const F along =
            select(above, c.top * angle, length_top + slant + c.bottom * (angle - bend));
        cap.position.y = cap.position.y + offset;
        cap.uv.y = along / whole;
        cap.dpdv = cap.dpdv * (whole / (end_cap.radius * F(pi_f)));
        cap.error = cap.error + c.half_height * F(surface_slack);
        choose(out, round, cap);
    }
    return out;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
