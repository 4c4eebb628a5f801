// camera/thin_lens.h - a perspective camera with one thin lens and one plane of sharp focus.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/aperture.h"
#include "camera/pinhole.h"

namespace obscura {

/// The lens in front of a PinholeCamera's film.
struct ThinLens {
    Aperture aperture;
    float inverse_focus = 0;  ///< 1 / distance of the sharp plane along -Z, 1/m; 0: infinitely far
};

inline namespace OBSCURA_ISA {

/// The ray from a point of the lens to the film point's position on the plane of focus. It leaves
/// the lens at z = 0 and meets the chief ray on the plane z = -focus. With radius 0 it is the
/// pinhole's ray.
///
/// In      plane: of the chief ray, at z = -1
/// Source  Cook, Porter, Carpenter, "Distributed Ray Tracing", SIGGRAPH 1984
template <typename F>
OBSCURA_INLINE CameraRay<F> lens_ray(const PinholeCamera& film,
                                     const ThinLens& lens,
                                     const Vec2<F>& plane,
                                     const Vec2<F>& lens_sample) {
    const Vec2<F> p = lens_point(lens.aperture, lens_sample);
    const F inverse_focus = F(lens.inverse_focus);
    const Vec2<F> towards = plane - p * inverse_focus;
    CameraRay<F> ray = ray_through(film, towards);
    ray.origin = {p.x, p.y, F(0.0f)};
    return ray;
}

}  // namespace OBSCURA_ISA

}  // namespace obscura
