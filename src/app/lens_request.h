// app/lens_request.h - checks lens options together and against the camera model.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/lens_options.h"
#include "base/error.h"
#include "scene/camera_settings.h"

namespace obscura::app {

/// Checks the parsed settings as a whole; --focus-on implies a lens.
///
/// In      model: --camera-model, if it was given
/// Errors  64 E-USAGE-CONFLICT: options that exclude each other, or that the camera model does not
///         have
Result<void> complete_lens(const LensArguments& arguments,
                           const std::optional<CameraModel>& model,
                           CameraSettings& settings);

}  // namespace obscura::app
