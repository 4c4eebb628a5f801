// shape/frustum.h - cylinders and cones with their caps, along the Y axis.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shape/surface_point.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// The hull of two circles around the Y axis. Equal radii make a cylinder, a radius of 0 a cone.
template <typename F>
struct Frustum {
    Vec3<F> centre;
    F half_height;
    F bottom, top;  ///< radii at -half_height and +half_height
};

/// The infinite cone through a frustum's side: its radius at height y is the radius at 0 plus
/// slope * y.
template <typename F>
struct ConeSide {
    F middle, slope;
};

/// The span of the near ray inside the half of the cone with positive radius. That half is convex,
/// so there is one span; intersected with a slab it leaves no cracks at the rims.
template <typename F>
OBSCURA_INLINE Span<F> span_in_cone(const NearRay<F>& ray, const ConeSide<F>& side) {
    const Vec3<F>& o = ray.origin;
    const Vec3<F>& d = ray.direction;
    const F radius = multiply_add(side.slope, o.y, side.middle);
    const F growth = side.slope * d.y;
    // a t^2 + 2 b t + c is below 0 inside, on both halves.
    const F a_exact = d.x * d.x + d.z * d.z - growth * growth;
    const F least = ray.squared * F(1e-20f);
    const F a = select(abs(a_exact) < least, least, a_exact);
    const F b = o.x * d.x + o.z * d.z - growth * radius;
    const F distance = sqrt(o.x * o.x + o.z * o.z);
    const F c = (distance - radius) * (distance + radius);
    // b^2 - a c is |radius d - growth o|^2 - (o x d)^2, both in x and z: near the axis a difference
    // of small numbers, where b^2 and a c are large ones. Half of the digits of the apex depend on
    // it.
    const F across = abs(difference_of_products(o.x, d.z, o.z, d.x));
    const F along_x = difference_of_products(radius, d.x, growth, o.x);
    const F along_z = difference_of_products(radius, d.z, growth, o.z);
    const F along = sqrt(along_x * along_x + along_z * along_z);
    const F discriminant = (along - across) * (along + across) - (a - a_exact) * c;
    const Quadratic<F> q = solve_quadratic(a, b, c, discriminant);
    const auto flat = a > F(0.0f);  // the line crosses one half; a steep line is in both, once each
    const auto wanted = flat & q.real & (radius - growth * b / a >= F(0.0f));
    const auto grows = growth > F(0.0f);
    const F ever(no_limit);
    return {select(flat, select(wanted, q.t.low, F(1.0f)), select(grows, q.t.high, F(-ever))),
            select(flat, select(wanted, q.t.high, F(0.0f)), select(grows, ever, q.t.low))};
}

template <typename F>
OBSCURA_INLINE ConeSide<F> cone_side(const Frustum<F>& f) {
    const F half(0.5f);
    return {(f.top + f.bottom) * half, (f.top - f.bottom) * half / f.half_height};
}

/// The span of the near ray (near the frustum's centre) inside the frustum with its caps.
template <typename F>
OBSCURA_INLINE Span<F> span_in_frustum(const NearRay<F>& ray, const Frustum<F>& frustum) {
    const Span<F> between = slab(ray.origin.y, ray.direction.y, frustum.half_height);
    return overlap(between, span_in_cone(ray, cone_side(frustum)));
}

template <typename F>
OBSCURA_INLINE Roots<F> intersect_frustum(const Frustum<F>& frustum, const ShapeRay<F>& ray) {
    const NearRay<F> near = bring_near(ray, frustum.centre);
    return on_ray(near, ends_of(span_in_frustum(near, frustum)));
}

/// The surface point on a cone's side around the Y axis near a given point; the caller sets v.
template <typename F>
OBSCURA_INLINE SurfacePoint<F> surface_of_cone_side(const ConeSide<F>& side,
                                                    const Vec3<F>& near,
                                                    const Azimuth<F>& around) {
    const F radius = max(side.middle + side.slope * near.y, F(0.0f));
    const F scale = F(1.0f) / sqrt(F(1.0f) + side.slope * side.slope);
    const F ring = F(2.0f * pi_f) * max(radius, F(1e-4f) * (abs(side.middle) + F(1e-30f)));
    SurfacePoint<F> out;
    out.position = {radius * around.sine, near.y, radius * around.cosine};
    out.normal = {around.sine * scale, -(side.slope * scale), around.cosine * scale};
    out.dpdu = {around.cosine * ring, F(0.0f), -(around.sine * ring)};
    out.dpdv = {-(side.slope * around.sine), F(-1.0f), -(side.slope * around.cosine)};
    out.uv = {around.turn, F(0.0f)};
    out.error = (abs(side.middle) + abs(side.slope * near.y) + abs(near.y)) * F(surface_slack);
    return out;
}

/// Side: u goes once around +Y (see Azimuth), v from the top to the bottom. Caps are cut out of a
/// square texture, the top with +Z at its lower edge, the bottom with -Z.
template <typename F>
OBSCURA_INLINE SurfacePoint<F> surface_of_frustum(const Frustum<F>& f, const Vec3<F>& near) {
    const F zero(0.0f);
    const ConeSide<F> side = cone_side(f);
    const Azimuth<F> around = azimuth_of(near.x, near.z);
    SurfacePoint<F> out = surface_of_cone_side(side, near, around);
    const F height = f.half_height + f.half_height;
    out.dpdv = out.dpdv * height;
    out.uv.y = (f.half_height - near.y) / height;
    const F slant = sqrt(F(1.0f) + side.slope * side.slope);
    const F from_side = abs(around.radius - (side.middle + side.slope * near.y)) / slant;
    const F from_cap = abs(f.half_height - abs(near.y));
    const auto up = near.y > zero;
    const F cap_radius = select(up, f.top, f.bottom);
    const auto cap = (from_cap < from_side) & (cap_radius > zero);
    const F sign = select(up, F(1.0f), F(-1.0f));
    const F width = select(cap, cap_radius + cap_radius, F(1.0f));
    SurfacePoint<F> flat;
    flat.position = {near.x, sign * f.half_height, near.z};
    flat.normal = {zero, sign, zero};
    flat.dpdu = {width, zero, zero};
    flat.dpdv = {zero, zero, sign * width};
    flat.uv = {near.x / width + F(0.5f), sign * near.z / width + F(0.5f)};
    flat.error = f.half_height * F(surface_slack);
    choose(out, cap, flat);
    return out;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
