// gltf/camera_extension.h - reads the extension OBSCURA_camera of a glTF camera.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/json_read.h"
#include "scene/camera_settings.h"

namespace obscura {

inline constexpr const char* camera_extension_name = "OBSCURA_camera";

/// Reads the extension's object; docs/extensions/OBSCURA_camera/README.md specifies it.
///
/// Errors  faults of the reader: 65 E-CAM-KEY a key that the specification does not have,
///         E-CAM-VALUE a value out of its range, E-JSON-TYPE
CameraSettings read_camera_extension(const JsonReader& object);

}  // namespace obscura
