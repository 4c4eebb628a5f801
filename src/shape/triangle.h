// shape/triangle.h - ray and triangle by barycentric coordinates: a system of three equations.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shape/roots.h"

namespace obscura {
inline namespace OBSCURA_ISA {

template <typename F>
struct Triangle {
    Vec3<F> a, b, c;
};

template <typename F>
struct TriangleHit {
    F t;
    F beta, gamma;  ///< weights of b and c
    MaskOf<F> hit;  ///< of the line: t may be negative
};

/// Solves R_o + t R_d = a + beta (b - a) + gamma (c - a) for (beta, gamma, t) by Cramer's rule. A
/// point on an edge or a corner counts as inside; a triangle seen edge-on is missed.
template <typename F>
OBSCURA_INLINE TriangleHit<F> intersect_triangle(const Triangle<F>& triangle,
                                                 const ShapeRay<F>& ray) {
    const Vec3<F> e1 = triangle.b - triangle.a;
    const Vec3<F> e2 = triangle.c - triangle.a;
    const Vec3<F> from_a = ray.origin - triangle.a;
    const Vec3<F> across = exact_cross(ray.direction, e2);
    const Vec3<F> turned = exact_cross(from_a, e1);
    const F determinant = dot(e1, across);
    const F inverse = F(1.0f) / determinant;
    const F beta = dot(from_a, across) * inverse;
    const F gamma = dot(ray.direction, turned) * inverse;
    const auto inside = (beta >= F(0.0f)) & (gamma >= F(0.0f)) & (beta + gamma <= F(1.0f));
    const MaskOf<F> hit = inside & (determinant != F(0.0f));
    return {dot(e2, turned) * inverse, beta, gamma, hit};
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
