// session/model_settings.h - checks camera settings against the model and against each other.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "scene/camera_settings.h"

#include <optional>

namespace obscura {

/// 64 E-USAGE-CONFLICT when a setting does not belong to a camera of that model.
Result<void> check_model_has(const CameraSettings& settings, CameraModel model);

/// 64 E-USAGE-CONFLICT when a setting is given that the camera's intrinsics leave without effect.
///
/// In      asked: over those of the camera; joined: both together, with the model
Result<void> check_beside_intrinsics(const CameraSettings& asked, const CameraSettings& joined);

/// The largest vertical angle of view that may be asked for; a fisheye's is that of its whole
/// circle.
///
/// In      model: the one that is named; without one the settings may imply it
double max_fov_deg(const std::optional<CameraModel>& model, const CameraSettings& settings);

/// 64 E-USAGE-CONFLICT when two settings exclude each other.
Result<void> check_settings_agree(const CameraSettings& settings);

}  // namespace obscura
