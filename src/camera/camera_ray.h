// camera/camera_ray.h - input and output of every camera model: a film point and a ray.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/transform.h"

namespace obscura {

/// Position of a sample. Film coordinates run over [0,1]^2, (0,0) is the image's top left corner.
template <typename F>
struct FilmPoint {
    Vec2<F> film;          ///< the sample; a filter may push it over the image's edge
    Vec2<F> pixel_centre;  ///< of its pixel: decides on the cube face and the eye
    Vec2<F> lens;          ///< uniform in [0,1)^2; ignored by cameras without a lens
};

/// A ray from a camera, with the cone that one pixel covers: width(t) = cone_width + cone_spread *
/// t.
template <typename F>
struct CameraRay {
    Vec3<F> origin;
    Vec3<F> direction;  ///< unit, finite for invalid rays too
    F cone_width;       ///< metres at the origin
    F cone_spread;      ///< metres of width per metre of distance
    MaskOf<F> valid;    ///< false: outside the camera's image
};

inline namespace OBSCURA_ISA {

/// The `valid` of models that fill the image.
template <typename F>
OBSCURA_INLINE MaskOf<F> always() {
    return MaskOf<F>(true);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
