// stages/3_moving_lights.h - punctual lights and light triangles at the time of the hit.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/punctual_sample.h"
#include "light/triangle_light.h"
#include "stages/3_tables.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Samples a punctual light at a time. Not inlined into light sampling, as few scenes need it.
///
/// In      LightView::moving_punctual is set; index: of the light; from: the lit point
void sample_moving_punctual(const SceneView& scene,
                            LanesI index,
                            Lanes time,
                            const Vec3<Lanes>& from,
                            PunctualSample<Lanes>& out);

/// Corners of light triangles at a time, and the density with which they are sampled.
///
/// In      LightView::moving_triangles is set; still: the corners of triangles that do not move
TriangleCorners<Lanes> moved_light_corners(const SceneView& scene,
                                           LanesI index,
                                           Lanes time,
                                           const TriangleCorners<Lanes>& still);

}  // namespace OBSCURA_ISA
}  // namespace obscura
