// session/focus.h - a camera that is focused on what one pixel shows.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render.h"

#include "session/render_request.h"

namespace obscura {

/// Chooses the camera, with all that focusing on a pixel can be refused for before there is a BVH.
///
/// Errors  those of choose_camera; 64 E-CAM-FOCUS the pixel is outside the picture, or the camera
///         has no lens
Result<ChosenCamera> choose_unfocused_camera(const Scene& scene,
                                             const RenderRequest& request,
                                             Log& log);

/// Where a pixel is to be in focus, a ray through the middle of the lens and of that pixel finds
/// the distance, along the view axis, at which the picture is sharp. Else nothing happens.
///
/// In      camera: of choose_unfocused_camera
/// Errors  64 E-CAM-FOCUS the pixel shows nothing; those of refocus and render
Result<void> focus(const PreparedScene& prepared,
                   const RenderRequest& request,
                   Log& log,
                   ChosenCamera& camera);

}  // namespace obscura
