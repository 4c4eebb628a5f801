// app/autofocus.h - the camera of a request, focused on what one pixel shows where that is asked.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/camera_choice.h"
#include "app/render_request.h"

namespace obscura {

/// Chooses the camera. With --focus-on, a ray through the middle of the lens and of that pixel
/// finds the distance, along the view axis, at which the picture is sharp.
///
/// Errors  those of choose_camera; 64 E-CAM-FOCUS the pixel is outside the picture or shows
///         nothing, or the camera has no lens; those of render
Result<ChosenCamera> choose_focused_camera(const PreparedScene& prepared,
                                           const RenderRequest& request,
                                           Log& log);

}  // namespace obscura
