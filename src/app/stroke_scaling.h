// app/stroke_scaling.h - points and lines get their size before the picture's camera is made.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/render_request.h"

namespace obscura {

/// Makes the points and lines of a loaded scene as thick as --point-size and --line-width ask for;
/// a scene without them stays as it is. --focus-on does not count: it needs the scene's geometry.
///
/// Errors  those of choose_camera, where a size is in pixels
Result<void> scale_strokes(const RenderRequest& request, Scene& scene);

}  // namespace obscura
