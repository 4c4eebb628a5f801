// session/model_settings.h - which settings a camera of a model can have.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "scene/camera_settings.h"

namespace obscura {

/// 64 E-USAGE-CONFLICT when a setting does not belong to a camera of that model.
Result<void> check_model_has(const CameraSettings& settings, CameraModel model);

}  // namespace obscura
