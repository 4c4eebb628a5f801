// camera/pinhole.h - the perspective camera without a lens.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/camera_ray.h"

namespace obscura {

struct PinholeCamera {
    float tan_half_yfov = 0.41421356f;  ///< > 0
    float aspect = 1;                   ///< width / height of the film, > 0
    float pixel_spread = 0.001f;        ///< 2 * tan_half_yfov / image height in pixels
    float shift_x = 0;                  ///< of the film, at distance 1; positive: sees more right
    float shift_y = 0;                  ///< positive: sees more above
};

inline namespace OBSCURA_ISA {

/// The film point on the plane z = -1 in front of the eye, where x grows to the right and y up.
template <typename F>
OBSCURA_INLINE Vec2<F> plane_from_film(const PinholeCamera& camera, const Vec2<F>& film) {
    const F half_height = F(camera.tan_half_yfov);
    return {(F(2.0f) * film.x - F(1.0f)) * half_height * F(camera.aspect) + F(camera.shift_x),
            (F(1.0f) - F(2.0f) * film.y) * half_height + F(camera.shift_y)};
}

/// Undoes plane_from_film.
template <typename F>
OBSCURA_INLINE Vec2<F> film_from_plane(const PinholeCamera& camera, const Vec2<F>& plane) {
    const F half_height = F(camera.tan_half_yfov);
    const F x = (plane.x - F(camera.shift_x)) / (half_height * F(camera.aspect));
    const F y = (plane.y - F(camera.shift_y)) / half_height;
    return {(x + F(1.0f)) * F(0.5f), (F(1.0f) - y) * F(0.5f)};
}

/// R_o = eye, R_d = pixel - eye, in camera space, for a point of the plane z = -1.
///
/// Source  Glassner (ed.), "An Introduction to Ray Tracing", 1989, ch. 2
template <typename F>
OBSCURA_INLINE CameraRay<F> ray_through(const PinholeCamera& camera, const Vec2<F>& plane) {
    const Vec3<F> through{plane.x, plane.y, F(-1.0f)};
    return {splat3(F(0.0f)), normalize(through), F(0.0f), F(camera.pixel_spread), always<F>()};
}

template <typename F>
OBSCURA_INLINE CameraRay<F> generate_ray(const PinholeCamera& camera, const FilmPoint<F>& point) {
    return ray_through(camera, plane_from_film(camera, point.film));
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
