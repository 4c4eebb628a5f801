// session/camera_choice.h - chooses the camera of an image: asked for, of the file, or framed.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"
#include "camera/aperture_table.h"
#include "camera/camera.h"
#include "scene/scene.h"
#include "session/camera_build.h"
#include "session/framing.h"
#include "session/view_sampling.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace obscura {

/// The camera that is asked for; empty members were not given.
struct CameraRequest {
    std::string choice = {};           ///< an exact name, else an index
    std::optional<size_t> index = {};  ///< in Scene::cameras, in place of `choice`
    std::optional<CameraModel> model = {};
    std::optional<Vec3d> eye_m = {};
    std::optional<Vec3d> target_m = {};
    std::optional<Vec3d> up = {};
    std::optional<double> yfov_rad = {};
    CameraSettings settings = {};  ///< all else; its model is `model`
    /// Pixel from the top left; the caller finds the distance (session/focus.h).
    std::optional<std::array<int, 2>> focus_on_px = {};
    /// Bounds that measure the scene in place of its own: in a sequence those of the first frame.
    std::optional<Bounds> framed = {};
    FramingOptions framing = {};   ///< of the automatic framing
    std::string framed_node = {};  ///< pattern of the names of nodes that the framing shows alone
    /// Those nodes and all below them, 1 by the node's number; empty: the whole scene.
    std::vector<char> framed_nodes = {};
    bool frames = false;  ///< the automatic framing goes before the file's cameras
    /// A view from inside the scene's box takes the place of the automatic framing.
    std::optional<InsideView> inside = {};
    /// The framing of a sequence's first frame, so that the view stands still while things move.
    std::optional<Framing> kept = {};
    /// Takes the place of the file's cameras.
    std::optional<SceneCamera> loaded = {};
};

struct ChosenCamera {
    Camera camera;
    CameraBasis basis;  ///< from which it was made, with `settings`
    ImageSize size;
    std::vector<Affined> moving;  ///< RenderOptions::moving_camera
    double znear_m = 0.01;        ///< for the NDC matrix; what is clipped is in `camera`
    double zfar_m = 1000;
    CameraSettings settings;      ///< those of the file and of the options together
    std::optional<double> ev100;  ///< the exposure that was asked for
    std::shared_ptr<const ApertureTable> aperture;  ///< what camera.thin_lens looks at
    std::optional<size_t> of_file = {};  ///< index in Scene::cameras, if it is one of those
    std::string description;             ///< "camera 'Front' of the file"
};

/// Chooses the camera:
///  0. `loaded`, whatever the file has;
///  1. any of eye, target, up: placed by hand; what is not given is taken from the automatic
///     framing (the vertical angle too);
///  2. the automatic framing where `frames` asks for it (session/framing.h);
///  3. `choice`: by exact name, else by index;
///  4. the file's first camera;
///  5. the automatic framing.
/// `yfov_rad` replaces the vertical angle of whichever camera that is; of a fisheye, its whole
/// angle. The settings replace what the file's OBSCURA_camera says, one by one. An orthographic
/// camera that comes from an angle shows what a pinhole with that angle shows at the target's
/// distance.
///
/// A file's camera never has its view cropped or stretched (glTF 2.0, section 3.10.3): an image
/// wider than the camera's aspect ratio shows more at the sides, a narrower one more above and
/// below. Without aspectRatio, yfov is kept. The node's scale is ignored.
///
/// Errors  64 E-CAM-UNKNOWN, E-CAM-AMBIGUOUS (the message lists the names), 64 E-CAM-VIEW eye and
///         target are the same or up is parallel to the view, E-USAGE-CONFLICT the camera's model
///         or its intrinsics leave no place for what an option says, those of
///         session/camera_build.h;
///         65 E-CAM-SINGULAR a node flattens its camera, 65 E-CAM-RANGE it does not fit 32-bit
///         floats; 67 E-IMG-* and E-APERTURE-* the image of an aperture
Result<ChosenCamera> choose_camera(
    const FramedScene& framed, const CameraRequest& request, int width_px, int height_px, Log& log);

/// RenderOptions::frame_cameras of a chosen camera; empty where it stands still, as cameras do that
/// are not the file's.
///
/// Errors  those of choose_camera
Result<std::vector<Camera>> choose_frame_cameras(const Scene& scene,
                                                 const CameraRequest& request,
                                                 const ChosenCamera& chosen);

/// The automatic framing of the scene; `kept`, where there is one.
Framing automatic_framing(const FramedScene& framed, const CameraRequest& request, double aspect);

/// Focuses at another distance along the view axis; all else stays.
///
/// Errors  64 E-CAM-LENS, 65 E-CAM-RANGE
Result<void> refocus(ChosenCamera& chosen, double distance_m, const std::string& file);

}  // namespace obscura
