// stages/3_light_alpha.h - alpha at the points of lights that light sampling chose.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/light_alpha.h"
#include "light/light_view.h"
#include "stages/column_lanes.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// The fraction of their light that the sampled points let out; 1 for opaque lights.
///
/// In      alpha: TriangleLight::alpha or ShapeLight::alpha; weight: as light_alpha takes it
inline __attribute__((noinline)) Lanes sampled_light_alpha(const SceneView& scene,
                                                           const LanesI& alpha,
                                                           const Vec2<Lanes>& weight) {
    const Mask exists = alpha >= LanesI(0);
    if (none(exists)) return Lanes(1.0f);
    const TableRecord<Lanes, LightAlpha> record(scene.lights.alphas,
                                                select(exists, alpha, LanesI(0)));
    return select(
        exists, light_alpha(scene.textures, read_light_alpha(record), weight), Lanes(1.0f));
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
