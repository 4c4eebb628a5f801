// session/camera_parameters.h - what a camera does, in words for a picture's header.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/camera.h"

#include <string>

namespace obscura {

/// What the camera does, as name=value pairs with a blank between them.
std::string camera_parameters(const Camera& camera);

}  // namespace obscura
