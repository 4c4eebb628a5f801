// session/model_settings.cpp - checks camera settings against the model and against each other.
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

Result<void> check_beside_intrinsics(const CameraSettings& asked, const CameraSettings& joined) {
    // The f-number tells the opening as a part of the focal length, which the sensor may tell.
    const bool needs_focal_length =
        joined.model == CameraModel::thin_lens && joined.fstop && !joined.lens_radius_m;
    const bool needs_sensor = needs_focal_length && !joined.focal_length_m;
    const char* const idle = asked.shift                                   ? "shift"
                             : asked.fisheye_fit                           ? "fisheye-fit"
                             : asked.sensor_m && !needs_sensor             ? "sensor"
                             : asked.focal_length_m && !needs_focal_length ? "focal-length"
                                                                           : nullptr;
    if (idle == nullptr) return {};
    return fail(ExitCode::usage,
                "E-USAGE-CONFLICT",
                setting(idle),
                "a camera given by fx, fy, cx and cy, or by K, does not have it: they say it "
                "already; leave it out, or change them");
}

double max_fov_deg(const std::optional<CameraModel>& model, const CameraSettings& settings) {
    const CameraModel meant =
        model.value_or(implied_model(settings).value_or(CameraModel::pinhole));
    return meant == CameraModel::fisheye ? 360 : 179;
}

Result<void> check_settings_agree(const CameraSettings& settings) {
    const auto conflict = [](const char* name, const std::string& message) {
        return fail(ExitCode::usage, "E-USAGE-CONFLICT", setting(name), message);
    };
    if (settings.ev100 && settings.shutter_s) {
        return conflict("ev100",
                        "it cannot go together with " + setting("exposure-time") + " or " +
                            setting("iso") + "; give one or the other");
    }
    if (settings.fisheye_k && settings.fisheye.value_or(FisheyeLaw::opencv) != FisheyeLaw::opencv) {
        return conflict(
            "fisheye-coefficients",
            "they are for " + setting("fisheye") + " opencv; leave out one or the other");
    }
    return {};
}

}  // namespace obscura
