// session/focus.h - autofocus: focuses a camera on what one pixel shows.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render.h"
#include "session/render_request.h"

namespace obscura {

/// Chooses the camera, and reports all errors of focusing that need no BVH.
///
/// Errors  those of choose_camera; 64 E-CAM-FOCUS the pixel is outside the image, or the camera
///         has no lens; E-CAM-OVERSCAN overscan around an image of all directions
Result<ChosenCamera> choose_unfocused_camera(const FramedScene& framed,
                                             const RenderRequest& request,
                                             Log& log);

/// When a pixel is to be in focus, a ray through the centres of the lens and of that pixel finds
/// the distance along the view axis at which the image is sharp. Otherwise does nothing.
///
/// In      camera: of choose_unfocused_camera
/// Errors  64 E-CAM-FOCUS the pixel shows nothing; those of refocus and render
Result<void> focus(const PreparedScene& prepared,
                   const RenderRequest& request,
                   Log& log,
                   ChosenCamera& camera);

}  // namespace obscura
