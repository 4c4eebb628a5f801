// scene/camera_settings.h - camera settings beyond glTF's core, whatever their source.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/camera.h"

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace obscura {

/// Focal lengths and principal point, in pixels of an image of the given size. (0, 0) is the top
/// left corner, so that the first pixel's centre is (0.5, 0.5).
struct Intrinsics {
    double width_px = 0;
    double height_px = 0;
    double fx_px = 0;
    double fy_px = 0;
    double cx_px = 0;
    double cy_px = 0;
};

/// How a fisheye's image circle fits the image: inside it (circle) or around it (diagonal).
enum class FisheyeFit : int { circle, diagonal };

/// The direction at the centre of a panorama: +X, as in environment maps (world), or ahead (view).
enum class EnvironmentAlign : int { world, view };

/// Empty: not given. docs/extensions/OBSCURA_camera/README.md has the meaning of each.
///
/// To add one: append it here and to scene/camera_setting_table.h, use it in
/// session/camera_build.cpp, and name the model in implied_model of scene/camera_settings.cpp if
/// the setting alone asks for it. An option is a text in app/lens_options.h and an entry in
/// app/lens_options.cpp; for the library, a member in include/obscura/view.h and a check in
/// session/library_request.cpp. Describe it in docs/cameras.md and in README.md and schema.json of
/// docs/extensions/OBSCURA_camera; docs/cli.md is printed by `obscura print-docs`.
struct CameraSettings {
    std::optional<CameraModel> model = {};
    std::optional<double> near_m = {};
    std::optional<double> far_m = {};
    std::optional<std::array<double, 2>> magnification_m = {};  ///< half width and half height
    std::optional<double> focal_length_m = {};
    std::optional<std::array<double, 2>> sensor_m = {};    ///< width, height
    std::optional<std::array<double, 2>> shift = {};       ///< in image sizes: right, up
    std::optional<std::array<double, 5>> distortion = {};  ///< k1 k2 p1 p2 k3
    std::optional<Intrinsics> intrinsics = {};

    std::optional<double> fstop = {};
    std::optional<double> lens_radius_m = {};
    std::optional<double> focus_distance_m = {};
    std::optional<int> blades = {};
    std::optional<double> blade_rotation_rad = {};
    std::optional<double> anamorphic = {};
    std::optional<std::string> aperture_file = {};

    std::optional<FisheyeLaw> fisheye = {};
    std::optional<double> fisheye_fov_rad = {};  ///< of the whole circle
    std::optional<FisheyeFit> fisheye_fit = {};
    std::optional<std::array<double, 4>> fisheye_k = {};

    std::optional<EnvironmentProjection> environment = {};
    std::optional<double> cylinder_fov_rad = {};  ///< vertical
    std::optional<double> stereo_m = {};          ///< between the eyes
    std::optional<EnvironmentAlign> align = {};

    std::optional<double> shutter_s = {};
    std::optional<double> iso = {};
    std::optional<double> ev100 = {};
};

/// The settings of `over`, completed by those of `base`. The lens' size counts as one setting, and
/// so does the exposure.
CameraSettings merge_settings(const CameraSettings& base, const CameraSettings& over);

/// The model that the settings name, or the only one that has all of them.
std::optional<CameraModel> implied_model(const CameraSettings& settings);

/// Name and value of each given setting, in a fixed order, for people.
std::vector<std::pair<std::string, std::string>> settings_texts(const CameraSettings& settings);

}  // namespace obscura
