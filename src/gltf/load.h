// gltf/load.h - a glTF 2.0 file (.gltf or .glb) becomes a scene.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"
#include "scene/scene.h"

#include <filesystem>
#include <string>

namespace obscura {

struct LoadOptions {
    int scene = -1;  ///< number of the scene in the file; -1: scene_name, else the file's own
    std::string scene_name;  ///< used when not empty and `scene` is -1
    std::string variant;     ///< of KHR_materials_variants; empty: the primitives' own materials
    bool info_only = false;  ///< images are only measured: Scene::textures.texels stays empty
};

/// Reads, checks and converts one asset with everything that it refers to.
///
/// Material 0 is the default material, for primitives without one; glTF material m is row m + 1
/// (behind them come copies without textures whose UV set a primitive lacks). Materials that the
/// chosen scene does not use keep their factors and lose their textures.
///
/// Errors  64 E-SCENE-UNKNOWN, E-VARIANT-UNKNOWN; 65 E-GLB-*, E-JSON-*, E-DOC-*, E-ACC-*, E-BUF-*,
/// E-MESH-*, E-NODE-*,
///         E-MESHOPT-*, E-DRACO-*;
///         66 E-SCENE-MISSING; 67 E-RES-MISSING, E-RES-SHORT, E-IMG-*; 69 E-VERSION,
///         E-EXT-REQUIRED, E-MESHOPT-VERSION, E-DRACO-VERSION; 77 E-URI-REFUSED, E-LIMIT-*; 33
///         E-MEMORY
Result<Scene> load_gltf(const std::filesystem::path& file, const LoadOptions& options, Log& log);

}  // namespace obscura
