// stages/1_shutter.h - stage 1, where something moves: the time of every path.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/stages.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Gives each path a time while the shutter is open, and moves its ray with the camera.
///
/// In      paths: fresh from the camera, one row a slot; scene.motion
/// Out     time: by slot, in [0, 1); one half where rays go through the pixels' centres
/// Source  Cook, Porter, Carpenter, "Distributed Ray Tracing", SIGGRAPH 1984
void open_shutter(
    const SceneView& scene, bool through_centres, int count, const PathRows& paths, float* time);

}  // namespace OBSCURA_ISA
}  // namespace obscura
