// camera/orthographic.h - parallel rays: size does not depend on distance.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/camera_ray.h"

namespace obscura {

struct OrthographicCamera {
    float half_width_m = 1;        ///< glTF xmag
    float half_height_m = 1;       ///< glTF ymag
    float pixel_width_m = 0.001f;  ///< 2 * half_height_m / image height in pixels
};

inline namespace OBSCURA_ISA {

/// R_o = point on the film plane, R_d = view direction, in camera space.
///
/// Source  glTF 2.0, section 3.10.3.4 (orthographic projection)
template <typename F>
OBSCURA_INLINE CameraRay<F> generate_ray(const OrthographicCamera& camera,
                                         const FilmPoint<F>& point) {
    const Vec2<F>& film = point.film;
    const Vec3<F> origin{(F(2.0f) * film.x - F(1.0f)) * F(camera.half_width_m),
                         (F(1.0f) - F(2.0f) * film.y) * F(camera.half_height_m),
                         F(0.0f)};
    const Vec3<F> forward{F(0.0f), F(0.0f), F(-1.0f)};
    return {origin, forward, F(camera.pixel_width_m), F(0.0f), always<F>()};
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
