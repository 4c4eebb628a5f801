// app/lens_request.h - from the texts of the lens options to checked settings.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/lens_options.h"
#include "base/error.h"
#include "scene/camera_settings.h"

namespace obscura {

/// Reads all but --camera-json and --focus-on; touches no file.
///
/// In      model: --camera-model, if it was given
/// Errors  64, each with the option and what it accepts: E-USAGE-NUMBER, E-USAGE-RANGE,
///         E-USAGE-CHOICE, E-USAGE-CONFLICT (options that exclude each other, or that the model
///         which they or --camera-model mean does not have)
Result<CameraSettings> parse_lens(const LensArguments& arguments,
                                  const std::optional<CameraModel>& model);

/// 64 E-USAGE-CONFLICT when an option says something that a camera of that model does not have.
Result<void> check_model_has(const CameraSettings& settings, CameraModel model);

}  // namespace obscura
