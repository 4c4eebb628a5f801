// camera/pinhole.h - the perspective camera without a lens.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/transform.h"

namespace obscura {

/// A ray from a camera, with the cone that one pixel covers: width(t) = cone_width + cone_spread *
/// t.
template <typename F>
struct CameraRay {
    Vec3<F> origin;
    Vec3<F> direction;  ///< unit
    F cone_width;       ///< metres at the origin
    F cone_spread;      ///< metres of width per metre of distance
};

struct PinholeCamera {
    float tan_half_yfov = 0.41421356f;  ///< > 0
    float aspect = 1;                   ///< width / height, > 0
    float pixel_spread = 0.001f;        ///< 2 * tan_half_yfov / picture height in pixels
};

inline namespace OBSCURA_ISA {

/// R_o = eye, R_d = pixel - eye, in camera space.
///
/// In      film: [0,1]^2, (0,0) top left
/// Source  Glassner (ed.), "An Introduction to Ray Tracing", 1989, ch. 2
template <typename F>
OBSCURA_INLINE CameraRay<F> generate_ray(const PinholeCamera& camera, const Vec2<F>& film) {
    const F half_height = F(camera.tan_half_yfov);
    const Vec3<F> through{(F(2.0f) * film.x - F(1.0f)) * half_height * F(camera.aspect),
                          (F(1.0f) - F(2.0f) * film.y) * half_height,
                          F(-1.0f)};
    return {splat3(F(0.0f)), normalize(through), F(0.0f), F(camera.pixel_spread)};
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
