// app/info_report.h - `obscura info`: a scene as text and as JSON.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"

#include <string>
#include <vector>

namespace obscura::app {

/// For people: one heading a line, details below it. Names are escaped.
std::string info_table(const Scene& scene);

/// For scripts: one document; docs/cli.md explains the keys.
std::string info_json(const Scene& scene, const std::vector<std::string>& warnings);

/// Memory of an image's texels with all mip levels; an image used both as colour and as data is
/// stored twice, an unused one not at all.
size_t texture_bytes(const ImageInfo& image);

/// Names of the file's own materials, in its order.
std::vector<std::string> file_materials(const Scene& scene);

/// Each mesh counted once.
size_t triangles_in_file(const AssetInfo& info);

const char* light_type_name(const PunctualLight& light);   ///< "point", "directional", "profile"
const char* light_unit_name(const PunctualLight& light);   ///< "candela", "lux", "times the ..."
const char* camera_type_name(const SceneCamera& camera);   ///< "perspective", "orthographic"
const char* camera_model_name(const SceneCamera& camera);  ///< as --camera-model has it

}  // namespace obscura::app
