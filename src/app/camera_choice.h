// app/camera_choice.h - which camera a picture is taken with: asked for, from the file, or framed.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"
#include "camera/aperture_table.h"
#include "camera/camera.h"
#include "scene/scene.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace obscura {

/// The camera options of the command line; what was not asked for is empty.
struct CameraRequest {
    std::string choice = {};                ///< --camera: an exact name, else an index
    std::optional<CameraModel> model = {};  ///< --camera-model
    std::optional<Vec3d> eye_m = {};
    std::optional<Vec3d> target_m = {};
    std::optional<Vec3d> up = {};
    std::optional<double> yfov_rad = {};  ///< --fov
    CameraSettings settings = {};         ///< all else; its model is `model`
    /// --focus-on: pixel from the top left; the caller finds the distance (app/autofocus.h).
    std::optional<std::array<int, 2>> focus_on_px = {};
    /// What the automatic framing shows in place of the whole scene: in a sequence the first
    /// frame's bounds, so that the view stands still while things move.
    std::optional<Bounds> framed = {};
    /// --camera-json: takes the place of the file's cameras.
    std::optional<SceneCamera> loaded = {};
};

struct ChosenCamera {
    Camera camera;
    std::vector<Affined> moving;  ///< RenderOptions::moving_camera
    double znear_m = 0.01;        ///< for the NDC matrix; what is clipped is in `camera`
    double zfar_m = 1000;
    CameraSettings settings;      ///< those of the file and of the options together
    std::optional<double> ev100;  ///< the exposure that was asked for
    std::shared_ptr<const ApertureTable> aperture;  ///< what camera.thin_lens looks at
    std::string description;                        ///< "camera 'Front' of the file"
};

/// Chooses the camera:
///  0. --camera-json, whatever the file has;
///  1. any of --eye, --target, --up: placed by hand; what is not given is taken from the automatic
///     framing (the vertical angle too);
///  2. --camera: by exact name, else by index;
///  3. the file's first camera;
///  4. the automatic framing (app/framing.h).
/// --fov replaces the vertical angle of whichever camera that is; of a fisheye, its whole angle.
/// The other options replace what the file's OBSCURA_camera says, one by one. An orthographic
/// camera that comes from an angle shows what a pinhole with that angle shows at the target's
/// distance.
///
/// A file's camera never has its view cropped or stretched (glTF 2.0, section 3.10.3): a picture
/// wider than the camera's aspect ratio shows more at the sides, a narrower one more above and
/// below. Without aspectRatio, yfov is kept. The node's scale is ignored.
///
/// Errors  64 E-CAM-UNKNOWN, E-CAM-AMBIGUOUS (the message lists the names), 64 E-CAM-VIEW eye and
///         target are the same or up is parallel to the view, E-USAGE-CONFLICT the camera's model
///         does not have what an option says, those of app/camera_build.h;
///         65 E-CAM-SINGULAR a node flattens its camera, 65 E-CAM-RANGE it does not fit 32-bit
///         floats; 67 E-IMG-* and E-APERTURE-* the picture of an aperture
Result<ChosenCamera> choose_camera(
    const Scene& scene, const CameraRequest& request, int width_px, int height_px, Log& log);

}  // namespace obscura
