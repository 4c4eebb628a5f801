// app/camera_choice.h - which camera a picture is taken with: asked for, from the file, or framed.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"
#include "camera/camera.h"
#include "scene/scene.h"

#include <optional>
#include <string>

namespace obscura {

/// The camera options of the command line; what was not asked for is empty.
struct CameraRequest {
    std::string choice = {};                ///< --camera: an exact name, else an index
    std::optional<CameraModel> model = {};  ///< --camera-model
    std::optional<Vec3d> eye_m = {};
    std::optional<Vec3d> target_m = {};
    std::optional<Vec3d> up = {};
    std::optional<double> yfov_rad = {};  ///< --fov
};

struct ChosenCamera {
    Camera camera;
    double znear_m = 0.01;  ///< for the NDC matrix only: nothing is clipped
    double zfar_m = 1000;
    std::string description;  ///< "camera 'Front' of the file"
};

/// Chooses the camera:
///  1. any of --eye, --target, --up: placed by hand; what is not given is taken from the automatic
///     framing (the vertical angle too);
///  2. --camera: by exact name, else by index;
///  3. the file's first camera;
///  4. the automatic framing (app/framing.h).
/// --fov replaces the vertical angle of whichever camera that is. An orthographic camera that
/// comes from an angle shows what a pinhole with that angle shows at the target's distance.
///
/// A file's camera never has its view cropped or stretched (glTF 2.0, section 3.10.3): a picture
/// wider than the camera's aspect ratio shows more at the sides, a narrower one more above and
/// below. Without aspectRatio, yfov is kept. The node's scale is ignored.
///
/// Errors  64 E-CAM-UNKNOWN, E-CAM-AMBIGUOUS (the message lists the names), 64 E-CAM-VIEW eye and
///         target are the same or up is parallel to the view; 65 E-CAM-SINGULAR a node flattens
///         its camera, 65 E-CAM-RANGE it does not fit 32-bit floats
Result<ChosenCamera> choose_camera(
    const Scene& scene, const CameraRequest& request, int width_px, int height_px, Log& log);

}  // namespace obscura
