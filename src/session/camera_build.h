// session/camera_build.h - makes a camera from its position, angle and settings.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "camera/camera.h"
#include "scene/camera_settings.h"

namespace obscura {

/// What is known of a camera before its settings are applied.
struct CameraBasis {
    Affined world_from_camera;  ///< rigid
    double tan_half_yfov = 0.4142;
    double half_height_m = 1;  ///< of a parallel view
    double focus_m = 10;       ///< sharp unless the settings say otherwise
    bool keeps_angle = false;  ///< the angle was asked for: a focal length must not change it
};

struct ImageSize {
    int width_px = 0, height_px = 0;
};

/// Position and orientation of a camera of a model: one that sees all around may keep to the
/// world's axes.
Affined camera_place(const Affined& world_from_camera,
                     CameraModel model,
                     const CameraSettings& settings);

/// Makes the camera without its aperture's image.
///
/// Errors  64 E-CAM-LENS a lens that cannot be, E-CAM-FISHEYE an angle that its law cannot show,
///         E-CAM-SIZE an image that does not suit the projection, E-CAM-CLIP far before near
Result<Camera> make_camera(const CameraBasis& basis,
                           CameraModel model,
                           const CameraSettings& settings,
                           ImageSize size);

/// The exposure value at ISO 100 that the settings ask for; none: no exposure was asked for.
///
/// Errors  64 E-CAM-EXPOSURE a shutter or ISO without the rest
Result<std::optional<double>> chosen_exposure(const CameraSettings& settings);

}  // namespace obscura
