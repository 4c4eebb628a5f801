// stages/1_shutter.h - stage 1, if something moves: draws a shutter time for every path.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/stages.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Gives each path a time while the shutter is open, and moves its ray with the camera.
///
/// In      paths: fresh from the camera, one per sample; scene.motion
/// Out     time: by sample index, in [0, 1); 0.5 where rays go through the pixels' centres
/// Source  Cook, Porter, Carpenter, "Distributed Ray Tracing", SIGGRAPH 1984
void open_shutter(
    const SceneView& scene, bool through_centres, int count, const PathColumns& paths, float* time);

}  // namespace OBSCURA_ISA
}  // namespace obscura
