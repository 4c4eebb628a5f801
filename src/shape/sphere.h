// shape/sphere.h - a sphere: both roots, from near, from inside and from very far away.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shape/surface_point.h"

namespace obscura {
inline namespace OBSCURA_ISA {

template <typename F>
struct Sphere {
    Vec3<F> centre;
    F radius;
};

/// The span of the near ray inside a sphere around (0, offset, 0); empty if it misses. The near ray
/// begins close to the sphere's centre, so that the discriminant is a difference of squares no
/// larger than the radius's.
/// Source  as solve_quadratic; both roots are of the size of the sphere
template <typename F>
OBSCURA_INLINE Span<F> span_in_sphere(const NearRay<F>& ray, const F& offset, const F& radius) {
    const Vec3<F> f{ray.origin.x, ray.origin.y - offset, ray.origin.z};
    const F middle = -dot(f, ray.direction) / ray.squared;
    const Vec3<F> side{multiply_add(middle, ray.direction.x, f.x),
                       multiply_add(middle, ray.direction.y, f.y),
                       multiply_add(middle, ray.direction.z, f.z)};
    const F distance = length(side);
    const F squared_half = (radius - distance) * (radius + distance) / ray.squared;
    const F half = sqrt(max(squared_half, F(0.0f)));
    const auto met = squared_half >= F(0.0f);
    return {select(met, middle - half, F(1.0f)), select(met, middle + half, F(0.0f))};
}

template <typename F>
OBSCURA_INLINE Roots<F> intersect_sphere(const Sphere<F>& sphere, const ShapeRay<F>& ray) {
    const NearRay<F> near = bring_near(ray, sphere.centre);
    return on_ray(near, ends_of(span_in_sphere(near, F(0.0f), sphere.radius)));
}

/// Texture as on a globe: u goes once around +Y (see Azimuth), v from the top, +Y, to the bottom.
///
/// In   near: a point close to the surface, relative to the centre
template <typename F>
OBSCURA_INLINE SurfacePoint<F> surface_of_sphere(const Sphere<F>& sphere, const Vec3<F>& near) {
    const Vec3<F> n = normalize(near);
    const Azimuth<F> around = azimuth_of(n.x, n.z);
    const F turn = F(2.0f * pi_f) * sphere.radius;
    const F half_turn = F(pi_f) * sphere.radius;
    // On the axis dpdu would be zero; a minimum keeps tangents valid.
    const F ring = max(around.radius, F(1e-4f)) * turn;
    SurfacePoint<F> out;
    out.position = n * sphere.radius;
    out.normal = n;
    out.dpdu = {around.cosine * ring, F(0.0f), -(around.sine * ring)};
    out.dpdv = {n.y * around.sine * half_turn,
                -(around.radius * half_turn),
                n.y * around.cosine * half_turn};
    out.uv = {around.turn, atan2(around.radius, n.y) * F(1.0f / pi_f)};
    out.error = sphere.radius * F(surface_slack);
    return out;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
