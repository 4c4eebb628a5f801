// gltf/camera_json.h - reads a computer vision camera (intrinsics, extrinsics) from JSON.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/json/json_read.h"
#include "base/log.h"
#include "scene/scene.h"

#include <array>
#include <filesystem>
#include <optional>

namespace obscura::gltf {

/// Reads intrinsics and extrinsics; docs/cameras.md has the keys. The file's camera axes are
/// OpenCV's (+X right, +Y down, +Z forward), its world is glTF's. The result has `intrinsics`, its
/// pinhole or fisheye model, and the file's name.
///
/// Errors  67 E-CAMJSON-MISSING the file cannot be read; 65 E-JSON-*, E-DOC-MISSING, E-CAM-KEY,
///         E-CAM-VALUE, E-CAM-MATRIX the matrix is not a rotation
Result<SceneCamera> load_camera_json(const std::filesystem::path& file, Log& log);

/// Reads the same keys of an object that may have others; its name stays empty.
///
/// In      tree: the same object; size_px: what width and height are where they are absent
/// Out     reader: the faults
SceneCamera read_camera(const JsonReader& reader,
                        const nlohmann::json& tree,
                        std::optional<std::array<int, 2>> size_px);

/// True where the 3x3 part is a rotation, within a thousandth.
bool is_rotation(const Affined& a);

/// True when an object has a key that says where such a camera is or how it projects.
bool has_camera_keys(const JsonReader& reader);

}  // namespace obscura::gltf
