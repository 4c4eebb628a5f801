// session/requested_camera.h - reads the camera of --camera-json before anything else.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/render_request.h"

namespace obscura {

/// Reads --camera-json; without --size the image gets the size that the file names.
///
/// Errors  those of load_camera_json; 64 E-USAGE-CONFLICT --crop reaches beyond that image
Result<void> load_requested_camera(RenderRequest& request, Log& log);

}  // namespace obscura
