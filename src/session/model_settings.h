// session/model_settings.h - which settings a camera of a model can have.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "scene/camera_settings.h"

namespace obscura {

/// 64 E-USAGE-CONFLICT when something is set that a camera of that model does not have.
Result<void> check_model_has(const CameraSettings& settings, CameraModel model);

}  // namespace obscura
