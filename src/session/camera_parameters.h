// session/camera_parameters.h - describes a camera's settings in an image's header.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/camera.h"

#include <string>

namespace obscura {

/// The camera's settings as name=value pairs with a blank between them.
std::string camera_parameters(const Camera& camera);

}  // namespace obscura
