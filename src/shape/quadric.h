// shape/quadric.h - any surface of second order, cut by a box.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shape/surface_point.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// A x^2 + B y^2 + C z^2 + D xy + E xz + F yz + G x + H y + I z + J = 0, in this order, with x, y,
/// z relative to the centre of the box. The front is the side where the left side is above 0.
template <typename F>
struct Quadric {
    Vec3<F> centre;
    Vec3<F> half;  ///< half edges of the box
    F k[10];
};

/// The left side of the equation.
template <typename F>
OBSCURA_INLINE F quadric_value(const Quadric<F>& q, const Vec3<F>& p) {
    return p.x * (q.k[0] * p.x + q.k[3] * p.y + q.k[6]) +
           p.y * (q.k[1] * p.y + q.k[5] * p.z + q.k[7]) +
           p.z * (q.k[2] * p.z + q.k[4] * p.x + q.k[8]) + q.k[9];
}

/// The absolute values of all coefficients, for bounds of rounding errors.
template <typename F>
OBSCURA_INLINE Quadric<F> quadric_sizes(const Quadric<F>& q) {
    Quadric<F> sizes = q;
    for (F& k : sizes.k)
        k = abs(k);
    return sizes;
}

template <typename F>
OBSCURA_INLINE Vec3<F> quadric_gradient(const Quadric<F>& q, const Vec3<F>& p) {
    const F two(2.0f);
    return {two * q.k[0] * p.x + q.k[3] * p.y + q.k[4] * p.z + q.k[6],
            q.k[3] * p.x + two * q.k[1] * p.y + q.k[5] * p.z + q.k[7],
            q.k[4] * p.x + q.k[5] * p.y + two * q.k[2] * p.z + q.k[8]};
}

/// Half the second derivative of the left side along a direction.
template <typename F>
OBSCURA_INLINE F quadric_bend(const Quadric<F>& q, const Vec3<F>& d) {
    return d.x * (q.k[0] * d.x + q.k[3] * d.y) + d.y * (q.k[1] * d.y + q.k[5] * d.z) +
           d.z * (q.k[2] * d.z + q.k[4] * d.x);
}

template <typename F>
OBSCURA_INLINE MaskOf<F> is_in_box(const Quadric<F>& q, const Vec3<F>& p) {
    return (abs(p.x) <= q.half.x) & (abs(p.y) <= q.half.y) & (abs(p.z) <= q.half.z);
}

/// A root after one safe Newton step towards the surface, and whether it is inside the box.
///
/// In   steady: no step, because the line is tangent to the surface and the step would be noise
template <typename F>
OBSCURA_INLINE NearHit<F> refined_root(const Quadric<F>& q,
                                       const NearRay<F>& ray,
                                       const F& root,
                                       const MaskOf<F>& steady) {
    const Vec3<F> p = point_at(ray, root);
    const F slope = dot(quadric_gradient(q, p), ray.direction);
    const F step = quadric_value(q, p) / slope;
    const F far = max_component(q.half) * F(1e-3f) / sqrt(ray.squared);
    const F t = select((abs(step) < far) & !steady, root - step, root);
    return {t, is_in_box(q, point_at(ray, t))};
}

/// Relative rounding error of the left side's sum.
template <typename F>
inline constexpr float value_slack = 4.0f / 16777216.0f;
template <>
inline constexpr float value_slack<double> = 4.0f / 16777216.0f / 536870912.0f;

/// Intersections of a line with the whole surface, ignoring the box.
template <typename F>
struct QuadricRoots {
    Quadratic<F> solved;
    MaskOf<F> touch;  ///< double root: the line is tangent there
};

/// Solves again relative to the midpoint of the roots: the equation's terms there are as small as
/// the roots are close. If the left side there is within rounding, the line counts as tangent: a
/// squared plane is one surface, not two by rounding.
///
/// In   a, b: of the equation from the near ray's origin
template <typename F>
OBSCURA_INLINE QuadricRoots<F> solve_from_middle(const Quadric<F>& q,
                                                 const NearRay<F>& ray,
                                                 const F& a,
                                                 const F& b) {
    const auto slope_at = [&](const F& t) {
        return F(0.5f) * dot(quadric_gradient(q, point_at(ray, t)), ray.direction);
    };
    const F rough = -b / a;
    const F middle = rough - slope_at(rough) / a;
    const Vec3<F> p = point_at(ray, middle);
    const F value = quadric_value(q, p);
    const Quadratic<F> near = solve_quadratic(a, slope_at(middle), value);
    const F slack(value_slack<F>);
    const Vec3<F> moved = (abs(ray.origin) + abs(ray.direction) * abs(middle)) * slack;
    const Quadric<F> sizes = quadric_sizes(q);
    const F rounding = quadric_value(sizes, abs(p)) * slack + quadric_bend(sizes, moved);
    const MaskOf<F> touch = abs(value) <= rounding;
    const auto from_here = [&](const F& t) { return middle + select(touch, F(0.0f), t); };
    const MaskOf<F> real = near.real | touch;
    return {{{from_here(near.t.low), from_here(near.t.high)}, real}, touch};
}

/// Roots that are far apart, relative to their positions and the box, are solved once; close or
/// missing ones again, from their midpoint.
template <typename F>
OBSCURA_INLINE QuadricRoots<F> solve_quadric(const Quadric<F>& q, const NearRay<F>& ray) {
    const F a = quadric_bend(q, ray.direction);
    const F b = F(0.5f) * dot(quadric_gradient(q, ray.origin), ray.direction);
    QuadricRoots<F> roots{solve_quadratic(a, b, quadric_value(q, ray.origin)), MaskOf<F>(false)};
    const auto& t = roots.solved.t;
    const F gap = (t.high - t.low) * F(8.0f);
    const F widest = max_component(q.half);
    const MaskOf<F> apart = roots.solved.real & (abs(t.low + t.high) <= gap) &
                            (gap * gap * ray.squared >= widest * widest);
    const MaskOf<F> close = !apart;
    if (none(close)) return roots;
    const QuadricRoots<F> near = solve_from_middle(q, ray, a, b);
    roots.solved.t.low = select(close, near.solved.t.low, t.low);
    roots.solved.t.high = select(close, near.solved.t.high, t.high);
    roots.solved.real = (roots.solved.real & !close) | (near.solved.real & close);
    roots.touch = near.touch & close;
    return roots;
}

template <typename F>
OBSCURA_INLINE Roots<F> intersect_quadric(const Quadric<F>& q, const ShapeRay<F>& ray) {
    const NearRay<F> near = bring_near(ray, q.centre);
    const QuadricRoots<F> roots = solve_quadric(q, near);
    const MaskOf<F> no(false);
    if (none(roots.solved.real)) return {{F(0.0f), F(0.0f)}, {no, no}};
    const Span<F>& t = roots.solved.t;
    const NearHit<F> low = refined_root(q, near, t.low, roots.touch);
    const NearHit<F> high = refined_root(q, near, t.high, roots.touch);
    const MaskOf<F> first = roots.solved.real & low.found;
    const MaskOf<F> second = roots.solved.real & high.found;
    return on_ray<F>(near, {{low.t, high.t}, {first, second}});
}

/// True where the left side falls along a line at its root t: the line hits the front. A tangent
/// line stays in front if the left side has positive curvature.
template <typename F>
OBSCURA_INLINE MaskOf<F> falls_along(const Quadric<F>& q, const ShapeRay<F>& ray, const F& t) {
    const Vec3<F>& d = ray.direction;
    const F slope = dot(quadric_gradient(q, ray.origin - q.centre + d * t), d);
    const Vec3<F> corner = quadric_gradient(quadric_sizes(q), q.half);
    if (none(abs(slope) <= dot(corner, abs(d)) * F(1e-3f))) return slope < F(0.0f);
    const MaskOf<F> touch = solve_quadric(q, bring_near(ray, q.centre)).touch;
    return (touch & (quadric_bend(q, d) > F(0.0f))) | ((!touch) & (slope < F(0.0f)));
}

/// The unit gradient of the left side a step along the axis (X, Y or Z) of its largest second
/// derivative: the normal of a squared plane, whose own gradient is zero.
template <typename F>
OBSCURA_INLINE Vec3<F> steepest_direction(const Quadric<F>& q) {
    const F two(2.0f);
    const F x = abs(q.k[0]);
    const F y = abs(q.k[1]);
    const F z = abs(q.k[2]);
    const auto y_is_max = (y >= x) & (y >= z);
    const auto z_is_max = (!y_is_max) & (z >= x);
    const Vec3<F> rows[3] = {{two * q.k[0], q.k[3], q.k[4]},
                             {q.k[3], two * q.k[1], q.k[5]},
                             {q.k[4], q.k[5], two * q.k[2]}};
    const Vec3<F> row = select(z_is_max, rows[2], select(y_is_max, rows[1], rows[0]));
    const F size = length(row);
    const Vec3<F> up{F(0.0f), F(1.0f), F(0.0f)};
    return select(size > F(1e-18f), row * (F(1.0f) / max(size, F(1e-18f))), up);
}

/// u goes once around the box's vertical axis (see Azimuth), v from the box's top to its bottom;
/// with `from_above` u grows along +X and v along +Z as on a plane.
template <typename F>
OBSCURA_INLINE SurfacePoint<F> surface_of_quadric(const Quadric<F>& q,
                                                  const MaskOf<F>& from_above,
                                                  const Vec3<F>& near) {
    SurfacePoint<F> out;
    const F widest = max_component(q.half);
    const Quadric<F> sizes = quadric_sizes(q);
    // The gradient vanishes at the apex of a cone, and everywhere on a squared plane.
    const F least = max(quadric_bend(sizes, splat3(widest)) / widest * F(1e-5f), F(1e-18f));
    // Enough Newton steps for points found from a hundred thousand sizes away.
    const F most = widest * F(1e-3f);
    const F longest = widest * F(0.1f);
    Vec3<F> p = near;
    for (int i = 0; i < 3; ++i) {
        const Vec3<F> up_hill = quadric_gradient(q, p);
        const F steep = dot(up_hill, up_hill);
        const Vec3<F> step = up_hill * (quadric_value(q, p) / max(steep, F(1e-30f)));
        p = select((length(step) < longest) & (steep > least * least), p - step, p);
    }
    const Vec3<F> gradient = quadric_gradient(q, p);
    const F slope = length(gradient);
    const auto smooth = slope > least;
    const Vec3<F> n =
        select(smooth, gradient * (F(1.0f) / max(slope, F(1e-18f))), steepest_direction(q));
    out.position = p;
    out.normal = n;
    const F fuzzy = quadric_value(sizes, abs(p)) / max(slope, F(1e-18f)) * F(surface_slack);
    out.error = min(fuzzy, most);

    const Vec3<F> size = q.half + q.half;
    const Azimuth<F> around = azimuth_of(p.x, p.z);
    // Tangents: horizontal for the parametrisation around the axis, along X for that from above.
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
    // u must grow along dpdu and v along dpdv for either front.
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
