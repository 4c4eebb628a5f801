// gltf/camera_json.h - reads a computer vision camera (intrinsics, extrinsics) from JSON.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"
#include "scene/scene.h"

#include <filesystem>

namespace obscura::gltf {

/// Reads intrinsics and extrinsics; docs/cameras.md has the keys. The file's camera axes are
/// OpenCV's (+X right, +Y down, +Z forward), its world is glTF's. The result has `intrinsics`, its
/// pinhole or fisheye model, and the file's name.
///
/// Errors  67 E-CAMJSON-MISSING the file cannot be read; 65 E-JSON-*, E-DOC-MISSING, E-CAM-KEY,
///         E-CAM-VALUE, E-CAM-MATRIX the matrix is not a rotation
Result<SceneCamera> load_camera_json(const std::filesystem::path& file, Log& log);

}  // namespace obscura::gltf
