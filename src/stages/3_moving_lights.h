// stages/3_moving_lights.h - where moving lights are at the time of a hit.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/punctual_sample.h"
#include "light/triangle_light.h"
#include "stages/3_tables.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Light of a punctual light at a time. Apart from light sampling, which is long enough without.
///
/// In      LightView::moving_punctual is there; index: of the light; from: where it is wanted
void sample_moving_punctual(const SceneView& scene,
                            LanesI index,
                            Lanes time,
                            const Vec3<Lanes>& from,
                            PunctualSample<Lanes>& out);

/// Where triangles of the light table are at a time, and with which density they are sampled.
///
/// In      LightView::moving_triangles is there; still: of those that stand still
TriangleCorners<Lanes> moved_light_corners(const SceneView& scene,
                                           LanesI index,
                                           Lanes time,
                                           const TriangleCorners<Lanes>& still);

}  // namespace OBSCURA_ISA
}  // namespace obscura
