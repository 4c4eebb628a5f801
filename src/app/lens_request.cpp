// app/lens_request.cpp - checks lens options together and against the camera model.
// SPDX-License-Identifier: Apache-2.0
#include "app/lens_request.h"

#include "session/model_settings.h"

namespace obscura::app {

Result<void> complete_lens(const LensArguments& arguments,
                           const std::optional<CameraModel>& model,
                           CameraSettings& settings) {
    if (auto agree = check_settings_agree(settings); !agree) return agree;
    // Only a lens can be focused.
    if (arguments.focus_on && !implied_model(settings)) settings.model = CameraModel::thin_lens;
    // Without --camera-model the file decides: choose_camera checks later.
    const std::optional<CameraModel> meant = model ? model : implied_model(settings);
    if (!meant) return {};
    if (arguments.focus_on && *meant != CameraModel::thin_lens) {
        return fail(
            ExitCode::usage,
            "E-USAGE-CONFLICT",
            "--focus-on",
            "only a thin lens can be focused; leave it out or choose another --camera-model");
    }
    return check_model_has(settings, *meant);
}

}  // namespace obscura::app
