// shape/roots.h - rays for shapes, robust quadratic roots, and the nearest hit.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/exact.h"

namespace obscura {

inline constexpr float no_limit = 3.0e38f;  ///< limit of a line without an end

inline namespace OBSCURA_ISA {

/// R(t) = origin + t * direction. The direction need not have length 1, only more than 0.
template <typename F>
struct ShapeRay {
    Vec3<F> origin, direction;
};

/// Both intersections of a line with a shape, before and behind the ray's origin: t[0] <= t[1] if
/// both are hits. t is undefined where `hit` is false.
template <typename F>
struct Roots {
    F t[2];
    MaskOf<F> hit[2];
};

/// The part of a line inside a convex shape; empty if high < low.
template <typename F>
struct Span {
    F low, high;
};

template <typename F>
OBSCURA_INLINE Span<F> overlap(const Span<F>& a, const Span<F>& b) {
    return {max(a.low, b.low), min(a.high, b.high)};
}

/// The ends of a span as roots: the line's entry and exit.
template <typename F>
OBSCURA_INLINE Roots<F> ends_of(const Span<F>& span) {
    const MaskOf<F> met = span.low <= span.high;
    return {{span.low, span.high}, {met, met}};
}

template <typename F>
struct NearHit {
    F t;
    MaskOf<F> found;
};

/// The first root in (tnear, tfar].
template <typename F>
OBSCURA_INLINE NearHit<F> nearest(const Roots<F>& roots, const F& tnear, const F& tfar) {
    const auto first = roots.hit[0] & (roots.t[0] > tnear) & (roots.t[0] <= tfar);
    const auto second = roots.hit[1] & (roots.t[1] > tnear) & (roots.t[1] <= tfar);
    const MaskOf<F> found = first | second;
    return {select(first, roots.t[0], roots.t[1]), found};
}

/// A ray moved to its point nearest to a centre, so that numbers are as small as the shape, however
/// far away the ray begins.
template <typename F>
struct NearRay {
    Vec3<F> origin;     ///< relative to the centre
    Vec3<F> direction;  ///< as the ray's
    F squared;          ///< squared length of the direction
    F t;                ///< position of the new origin on the ray
};

/// The new origin is rounded once: its error is relative to itself, not to the distance to it.
template <typename F>
OBSCURA_INLINE NearRay<F> bring_near(const ShapeRay<F>& ray, const Vec3<F>& centre) {
    const Vec3<F>& d = ray.direction;
    const Exact<F> x = two_sum(ray.origin.x, F(-centre.x));
    const Exact<F> y = two_sum(ray.origin.y, F(-centre.y));
    const Exact<F> z = two_sum(ray.origin.z, F(-centre.z));
    NearRay<F> near;
    near.direction = d;
    near.squared = dot(d, d);
    near.t = -dot(Vec3<F>{x.value, y.value, z.value}, d) / near.squared;
    near.origin = {multiply_add(near.t, d.x, x.value) + x.error,
                   multiply_add(near.t, d.y, y.value) + y.error,
                   multiply_add(near.t, d.z, z.value) + z.error};
    return near;
}

/// The point at `t` (on the near ray), relative to the centre.
template <typename F>
OBSCURA_INLINE Vec3<F> point_at(const NearRay<F>& ray, const F& t) {
    return {multiply_add(t, ray.direction.x, ray.origin.x),
            multiply_add(t, ray.direction.y, ray.origin.y),
            multiply_add(t, ray.direction.z, ray.origin.z)};
}

/// Converts parameters on the near ray to parameters on the ray itself.
template <typename F>
OBSCURA_INLINE Roots<F> on_ray(const NearRay<F>& ray, const Roots<F>& near) {
    return {{near.t[0] + ray.t, near.t[1] + ray.t}, {near.hit[0], near.hit[1]}};
}

/// Real solutions of a t^2 + 2 b t + c = 0, in order; real is false where there are none.
template <typename F>
struct Quadratic {
    Span<F> t;
    MaskOf<F> real;
};

/// Neither root suffers from cancellation. Missing roots are infinite or NaN and fail any limits:
/// one root if a = 0, both if b = 0 too (a line along a ruling).
///
/// In      discriminant: b^2 - a c, where it is known better than the rounded a, b and c tell
/// Source  Haines et al., "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems,
///         2019, ch. 7
template <typename F>
OBSCURA_INLINE Quadratic<F> solve_quadratic(const F& a,
                                            const F& b,
                                            const F& c,
                                            const F& discriminant) {
    const F root = sqrt(max(discriminant, F(0.0f)));
    const F q = select(b < F(0.0f), root - b, F(-(b + root)));
    const F second = q / a;
    const F first = select(q == F(0.0f), second, c / q);
    const auto ordered = first < second;
    return {{select(ordered, first, second), select(ordered, second, first)},
            discriminant >= F(0.0f)};
}

/// Source  Kahan (as difference_of_products)
template <typename F>
OBSCURA_INLINE Quadratic<F> solve_quadratic(const F& a, const F& b, const F& c) {
    return solve_quadratic(a, b, c, difference_of_products(b, b, a, c));
}

/// The part of a line between two parallel planes: |origin + t * direction| <= half along one axis.
template <typename F>
OBSCURA_INLINE Span<F> slab(const F& origin, const F& direction, const F& half) {
    // A line parallel to the planes is between them everywhere or nowhere: 1e30 acts as infinity.
    const F least(1e-30f);
    const F steep = select(abs(direction) < least, least, direction);
    const F inverse = F(1.0f) / steep;
    const F a = (-half - origin) * inverse;
    const F b = (half - origin) * inverse;
    return {min(a, b), max(a, b)};
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
