// session/model_settings.cpp - which settings a camera of a model can have.
// SPDX-License-Identifier: Apache-2.0
#include "session/model_settings.h"

#include "base/setting_names.h"
#include "camera/names.h"
#include "scene/camera_setting_table.h"

#include <string>

namespace obscura {

Result<void> check_model_has(const CameraSettings& settings, CameraModel model) {
    const CameraSettingInfo* lacking = setting_without(settings, model);
    if (!lacking) return {};
    return fail(ExitCode::usage,
                "E-USAGE-CONFLICT",
                setting(lacking->name),
                std::string("a camera of the model ") + name_of(camera_model_names, model) +
                    " does not have it; leave it out or choose another " + setting("camera-model"));
}

}  // namespace obscura
