// session/library_camera.h - the camera that a library's caller gives as OpenCV describes it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/camera_choice.h"

#include <obscura/view.h>

namespace obscura {

/// Makes View::opencv, if it is set, the camera of the request, as --camera-json does.
///
/// Errors  65 E-CAM-VALUE, E-CAM-MATRIX, as of a file's keys; their place is "opencv#/K"
Result<void> place_opencv(const v0::View& view, CameraRequest& request);

}  // namespace obscura
