// stages/1_camera.h - stage 1: film points become rays.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/lanes.h"
#include "stages/path_state.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// From pixels to film coordinates.
struct FilmScale {
    Vec2<Lanes> inverse_size;

    OBSCURA_INLINE explicit FilmScale(const BatchSettings& batch)
        : inverse_size{Lanes(1.0f / static_cast<float>(batch.width)),
                       Lanes(1.0f / static_cast<float>(batch.height))} {}

    /// offset: from the pixel's centre, in pixels
    OBSCURA_INLINE Vec2<Lanes> operator()(LanesI x, LanesI y, const Vec2<Lanes>& offset) const {
        return {(from_int<Lanes>(x) + Lanes(0.5f) + offset.x) * inverse_size.x,
                (from_int<Lanes>(y) + Lanes(0.5f) + offset.y) * inverse_size.y};
    }
};

/// In      batch.pixel_x/y, samples, first_sample: which film points; count: pixels * samples
/// Out     out: one path per sample, in sample order; throughput 0 outside the camera's image;
///         samples: cleared; length_m: how far each ray may go, null where !limits_rays(camera)
/// Units   metres; key and sample feed math/sampler.h
/// Errors  none
void make_camera_rays(const BatchSettings& batch,
                      int count,
                      const PathColumns& out,
                      const SampleColumns& samples,
                      float* length_m);

/// For AOVs: one ray through the centre of each pixel (plus batch.film_offset_px), in the order of
/// batch.pixel_x. Writes only origin, direction and cone.
void make_centre_rays(const BatchSettings& batch,
                      int count,
                      const PathColumns& out,
                      float* length_m);

}  // namespace OBSCURA_ISA
}  // namespace obscura
