// app/lens_request.h - what the lens options mean together, and for which camera models.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/lens_options.h"
#include "base/error.h"
#include "scene/camera_settings.h"

namespace obscura {

/// Looks at the settings that were read as a whole, and lets --focus-on mean a lens.
///
/// In      model: --camera-model, if it was given
/// Errors  64 E-USAGE-CONFLICT: options that exclude each other, or that the model which they or
///         --camera-model mean does not have
Result<void> complete_lens(const LensArguments& arguments,
                           const std::optional<CameraModel>& model,
                           CameraSettings& settings);

}  // namespace obscura
