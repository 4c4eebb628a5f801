// session/opencv_camera.h - a chosen camera as computer vision writes it: K, R and t.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/json/json.h"
#include "scene/camera_settings.h"
#include "session/camera_choice.h"

#include <optional>

namespace obscura {

/// None: the camera has none (orthographic, fisheye, all directions).
std::optional<Intrinsics> intrinsics_of(const Camera& camera, const ImageSize& size);

/// camera_from_world by OpenCV's axes: X_camera = R X_world + t, with +X to the right, +Y down, +Z
/// ahead.
Affined opencv_from_world(const Camera& camera);

/// K as rows; null: there are no intrinsics.
Json intrinsics_json(const ChosenCamera& chosen, const ImageSize& size);

/// Adds "R" as rows and "t", of opencv_from_world.
void add_pose_json(const Camera& camera, Json& out);

}  // namespace obscura
