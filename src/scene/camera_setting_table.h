// scene/camera_setting_table.h - the table of camera settings: names, units, ranges, models.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/names.h"
#include "scene/camera_settings.h"

#include <span>
#include <tuple>

namespace obscura {

/// A camera model as a bit, so that several make a set.
constexpr unsigned model_bit(CameraModel model) {
    return 1U << static_cast<unsigned>(model);
}

namespace camera_models {
inline constexpr unsigned orthographic = model_bit(CameraModel::orthographic);
inline constexpr unsigned lens = model_bit(CameraModel::thin_lens);
inline constexpr unsigned flat = lens | model_bit(CameraModel::pinhole);
inline constexpr unsigned fisheye = model_bit(CameraModel::fisheye);
inline constexpr unsigned around = model_bit(CameraModel::environment);
inline constexpr unsigned all = ~0U;
}  // namespace camera_models

/// Description of one setting for readers and writers.
struct CameraSettingInfo {
    const char* name = "";      ///< one word, as options have it: "focal-length"
    const char* report = "";    ///< in reports, with the unit: "focal_length_mm"; "": absent
    const char* section = "";   ///< object inside OBSCURA_camera: "lens"; "": the extension itself
    const char* key = nullptr;  ///< in that object; null: not in the extension
    struct {
        double low = 0, high = 0;
    } range = {};                          ///< in the member's unit, inclusive
    double shown = 1;                      ///< factor from the member's unit to the report's
    unsigned models = camera_models::all;  ///< those that have it
};

template <typename T>
struct CameraSetting {
    std::optional<T> CameraSettings::*member;
    CameraSettingInfo info;
    std::span<const Named<T>> choices = {};  ///< of enumerations
};

template <typename T>
constexpr CameraSetting<T> camera_setting(std::optional<T> CameraSettings::*member,
                                          const CameraSettingInfo& info,
                                          std::span<const Named<T>> choices = {}) {
    return {member, info, choices};
}

inline constexpr std::array<Named<FisheyeFit>, 2> fisheye_fit_names = {
    {{"circle", FisheyeFit::circle}, {"diagonal", FisheyeFit::diagonal}}};
inline constexpr std::array<Named<EnvironmentAlign>, 2> environment_align_names = {
    {{"world", EnvironmentAlign::world}, {"view", EnvironmentAlign::view}}};

inline constexpr double max_camera_m = 1e12;
inline constexpr double degrees_per_radian = 180 / pi_d;

// clang-format off
/// In the order of reports; gltf/parse/camera_extension.cpp reads the extension by this table.
inline constexpr auto camera_setting_table = std::tuple{
    camera_setting(&CameraSettings::near_m,
        {.name = "near", .report = "near_m", .key = "near", .range = {0, max_camera_m}}),
    camera_setting(&CameraSettings::far_m,
        {.name = "far", .report = "far_m", .key = "far", .range = {1e-9, max_camera_m}}),
    camera_setting(&CameraSettings::magnification_m,
        {.name = "mag", .report = "mag_m", .range = {1e-9, max_camera_m},
         .models = camera_models::orthographic}),
    camera_setting(&CameraSettings::focal_length_m,
        {.name = "focal-length", .report = "focal_length_mm", .key = "focalLength",
         .range = {1e-5, 100}, .shown = 1000, .models = camera_models::flat}),
    camera_setting(&CameraSettings::sensor_m,
        {.name = "sensor", .report = "sensor_mm", .key = "sensor", .range = {1e-4, 10},
         .shown = 1000, .models = camera_models::flat}),
    camera_setting(&CameraSettings::shift,
        {.name = "shift", .report = "shift", .key = "shift", .range = {-100, 100},
         .models = camera_models::flat | camera_models::fisheye}),
    camera_setting(&CameraSettings::distortion,
        {.name = "distortion", .report = "distortion", .key = "distortion", .range = {-1e6, 1e6},
         .models = camera_models::flat}),
    camera_setting(&CameraSettings::intrinsics, {.name = "camera-json"}),
    camera_setting(&CameraSettings::fstop,
        {.name = "fstop", .report = "fstop", .section = "lens", .key = "fstop",
         .range = {0.01, 1e6}, .models = camera_models::lens}),
    camera_setting(&CameraSettings::lens_radius_m,
        {.name = "lens-radius", .report = "lens_radius_m", .section = "lens", .key = "radius",
         .range = {0, 1e9}, .models = camera_models::lens}),
    camera_setting(&CameraSettings::focus_distance_m,
        {.name = "focus-distance", .report = "focus_distance_m", .section = "lens",
         .key = "focusDistance", .range = {1e-9, max_camera_m}, .models = camera_models::lens}),
    camera_setting(&CameraSettings::blades,
        {.name = "blades", .report = "blades", .section = "lens", .key = "blades",
         .range = {3, 64}, .models = camera_models::lens}),
    camera_setting(&CameraSettings::blade_rotation_rad,
        {.name = "blade-rotation", .report = "blade_rotation_deg", .section = "lens",
         .key = "bladeRotation", .range = {-1000, 1000}, .shown = degrees_per_radian,
         .models = camera_models::lens}),
    camera_setting(&CameraSettings::anamorphic,
        {.name = "anamorphic", .report = "anamorphic", .section = "lens", .key = "anamorphic",
         .range = {0.01, 100}, .models = camera_models::lens}),
    camera_setting(&CameraSettings::aperture_file,
        {.name = "aperture", .models = camera_models::lens}),
    camera_setting(&CameraSettings::fisheye,
        {.name = "fisheye", .report = "fisheye", .section = "fisheye", .key = "projection",
         .models = camera_models::fisheye},
        std::span<const Named<FisheyeLaw>>(fisheye_law_names)),
    camera_setting(&CameraSettings::fisheye_fov_rad,
        {.name = "fov", .report = "fisheye_fov_deg", .section = "fisheye", .key = "fov",
         .range = {1e-4, 2 * pi_d}, .shown = degrees_per_radian,
         .models = camera_models::fisheye}),
    camera_setting(&CameraSettings::fisheye_fit,
        {.name = "fisheye-fit", .report = "fisheye_fit", .section = "fisheye", .key = "fit",
         .models = camera_models::fisheye},
        std::span<const Named<FisheyeFit>>(fisheye_fit_names)),
    camera_setting(&CameraSettings::fisheye_k,
        {.name = "fisheye-coefficients", .report = "fisheye_k", .section = "fisheye",
         .key = "coefficients", .range = {-1e6, 1e6}, .models = camera_models::fisheye}),
    camera_setting(&CameraSettings::environment,
        {.name = "environment", .report = "environment", .section = "environment",
         .key = "projection", .models = camera_models::around},
        std::span<const Named<EnvironmentProjection>>(environment_projection_names)),
    camera_setting(&CameraSettings::cylinder_fov_rad,
        {.name = "fov", .report = "cylinder_fov_deg", .section = "environment", .key = "fov",
         .range = {1e-4, 3.1241}, .shown = degrees_per_radian,
         .models = camera_models::around}),
    camera_setting(&CameraSettings::stereo_m,
        {.name = "stereo", .report = "stereo_m", .section = "environment", .key = "stereo",
         .range = {0, 1e6}, .models = camera_models::around}),
    camera_setting(&CameraSettings::align,
        {.name = "align", .report = "align", .section = "environment", .key = "align",
         .models = camera_models::around},
        std::span<const Named<EnvironmentAlign>>(environment_align_names)),
    camera_setting(&CameraSettings::shutter_s,
        {.name = "shutter", .report = "shutter_s", .section = "exposure", .key = "shutter",
         .range = {1e-7, 1e7}}),
    camera_setting(&CameraSettings::iso,
        {.name = "iso", .report = "iso", .section = "exposure", .key = "iso",
         .range = {1e-3, 1e9}}),
    camera_setting(&CameraSettings::ev100,
        {.name = "ev100", .report = "ev100", .section = "exposure", .key = "ev100",
         .range = {-60, 60}})};
// clang-format on

/// The first given setting that cameras of this model do not have; null: there is none.
const CameraSettingInfo* setting_without(const CameraSettings& settings, CameraModel model);

/// Calls `body(entry)` with each entry of the table.
template <typename Body>
void for_each_camera_setting(const Body& body) {
    std::apply([&](const auto&... entries) { (body(entries), ...); }, camera_setting_table);
}

/// The entry of a member.
template <auto member>
constexpr auto camera_setting_of() {
    using T = typename std::remove_cvref_t<decltype(CameraSettings{}.*member)>::value_type;
    CameraSetting<T> out = {};
    const auto take = [&out]<typename Other>(const CameraSetting<Other>& entry) {
        if constexpr (std::is_same_v<Other, T>) {
            if (entry.member == member) out = entry;
        }
    };
    std::apply([&](const auto&... entries) { (take(entries), ...); }, camera_setting_table);
    return out;
}
static_assert(camera_setting_of<&CameraSettings::blades>().info.range.high == 64);
static_assert(camera_setting_of<&CameraSettings::align>().choices.size() == 2);

}  // namespace obscura
