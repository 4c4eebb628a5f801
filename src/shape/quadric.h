// shape/quadric.h - any surface of second order, cut by a box.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shape/surface_point.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// A x^2 + B y^2 + C z^2 + D xy + E xz + F yz + G x + H y + I z + J = 0, in this order, with x, y,
/// z relative to the centre of the box. The front is where the left side is above 0.
template <typename F>
struct Quadric {
    Vec3<F> centre;
    Vec3<F> half;  ///< of the box's edges
    F k[10];
};

/// The left side of the equation.
template <typename F>
OBSCURA_INLINE F quadric_value(const Quadric<F>& q, const Vec3<F>& p) {
    return p.x * (q.k[0] * p.x + q.k[3] * p.y + q.k[6]) +
           p.y * (q.k[1] * p.y + q.k[5] * p.z + q.k[7]) +
           p.z * (q.k[2] * p.z + q.k[4] * p.x + q.k[8]) + q.k[9];
}

/// The sum of its terms without their signs: what rounding is relative to.
template <typename F>
OBSCURA_INLINE F quadric_size(const Quadric<F>& q, const Vec3<F>& p) {
    Quadric<F> positive = q;
    for (F& k : positive.k)
        k = abs(k);
    return quadric_value(positive, abs(p));
}

template <typename F>
OBSCURA_INLINE Vec3<F> quadric_gradient(const Quadric<F>& q, const Vec3<F>& p) {
    const F two(2.0f);
    return {two * q.k[0] * p.x + q.k[3] * p.y + q.k[4] * p.z + q.k[6],
            q.k[3] * p.x + two * q.k[1] * p.y + q.k[5] * p.z + q.k[7],
            q.k[4] * p.x + q.k[5] * p.y + two * q.k[2] * p.z + q.k[8]};
}

/// A root, moved by one step of Newton's towards the surface where that is safe, and whether it is
/// inside the box.
template <typename F>
OBSCURA_INLINE NearHit<F> refined_root(const Quadric<F>& q, const NearRay<F>& ray, const F& root) {
    const Vec3<F> p = point_at(ray, root);
    const F slope = dot(quadric_gradient(q, p), ray.direction);
    const F step = quadric_value(q, p) / slope;
    const F far = max_component(q.half) * F(1e-3f) / sqrt(ray.squared);
    const F t = select(abs(step) < far, root - step, root);
    const Vec3<F> at = point_at(ray, t);
    const MaskOf<F> inside =
        (abs(at.x) <= q.half.x) & (abs(at.y) <= q.half.y) & (abs(at.z) <= q.half.z);
    return {t, inside};
}

template <typename F>
OBSCURA_INLINE Roots<F> intersect_quadric(const Quadric<F>& q, const ShapeRay<F>& ray) {
    const NearRay<F> near = bring_near(ray, q.centre);
    const Vec3<F>& o = near.origin;
    const Vec3<F>& d = near.direction;
    const F half(0.5f);
    const F a = d.x * (q.k[0] * d.x + q.k[3] * d.y) + d.y * (q.k[1] * d.y + q.k[5] * d.z) +
                d.z * (q.k[2] * d.z + q.k[4] * d.x);
    const F b = half * dot(quadric_gradient(q, o), d);
    const Quadratic<F> solved = solve_quadratic(a, b, quadric_value(q, o));
    const NearHit<F> low = refined_root(q, near, solved.t.low);
    const NearHit<F> high = refined_root(q, near, solved.t.high);
    const MaskOf<F> first = solved.real & low.found;
    const MaskOf<F> second = solved.real & high.found;
    return on_ray<F>(near, {{low.t, high.t}, {first, second}});
}

/// u goes once around the box's vertical axis (see Azimuth), v from the box's top to its bottom;
/// with `from_above` u grows along +X and v along +Z as on a plane.
template <typename F>
OBSCURA_INLINE SurfacePoint<F> surface_of_quadric(const Quadric<F>& q,
                                                  const MaskOf<F>& from_above,
                                                  const Vec3<F>& near) {
    SurfacePoint<F> out;
    // Newton's steps, as many as a point needs that was found from a hundred thousand sizes away.
    const F most = max_component(q.half) * F(1e-3f);
    const F longest = max_component(q.half) * F(0.1f);
    Vec3<F> p = near;
    for (int i = 0; i < 3; ++i) {
        const Vec3<F> up_hill = quadric_gradient(q, p);
        const F steep = max(dot(up_hill, up_hill), F(1e-30f));
        const Vec3<F> step = up_hill * (quadric_value(q, p) / steep);
        p = select(length(step) < longest, p - step, p);
    }
    const Vec3<F> gradient = quadric_gradient(q, p);
    const F slope = length(gradient);
    const auto smooth = slope > F(1e-18f);
    const Vec3<F> up{F(0.0f), F(1.0f), F(0.0f)};
    const Vec3<F> n = select(smooth, gradient * (F(1.0f) / max(slope, F(1e-18f))), up);
    out.position = p;
    out.normal = n;
    const F fuzzy = quadric_size(q, p) / max(slope, F(1e-18f)) * F(surface_slack);
    out.error = min(fuzzy, most);

    const Vec3<F> size = q.half + q.half;
    const Azimuth<F> around = azimuth_of(p.x, p.z);
    // Along the surface, level where it goes around the axis and along X where it is seen from
    // above.
    const Vec3<F> level{n.z, F(0.0f), -n.x};
    const Vec3<F> along{n.y, -n.x, F(0.0f)};
    const Vec3<F> raw = select(from_above, along, level);
    const auto safe = dot(raw, raw) > F(1e-12f);
    const Vec3<F> t = normalize(select(safe, raw, frame_around(n).tangent));
    const Vec3<F> b = cross(t, n);
    const F turning = abs(t.x * around.cosine - t.z * around.sine);
    const F ring = F(2.0f * pi_f) * around.radius / max(turning, F(0.05f));
    const F width = select(from_above, size.x / max(abs(t.x), F(0.05f)), ring);
    const F height =
        select(from_above, size.z / max(abs(b.z), F(0.05f)), size.y / max(abs(b.y), F(0.05f)));
    // u must grow along dpdu and v along dpdv, whichever side is the front.
    const F u_way = select(from_above, t.x, t.x * around.cosine - t.z * around.sine);
    const F v_way = select(from_above, b.z, F(-b.y));
    out.dpdu = t * select(u_way < F(0.0f), F(-width), max(width, F(1e-18f)));
    out.dpdv = b * select(v_way < F(0.0f), F(-height), max(height, F(1e-18f)));
    out.uv = {select(from_above, p.x / size.x + F(0.5f), around.turn),
              F(0.5f) + select(from_above, p.z / size.z, F(-p.y) / size.y)};
    return out;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
