// app/scene_choice.h - the options --scene and --variant, which several commands share.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "gltf/load.h"

#include <optional>
#include <string>

namespace obscura::app {

/// Digits alone are a scene's index, any other text its name; absent: the file's default.
///
/// Errors  64 E-USAGE-RANGE an index too large for any file, 64 E-USAGE-CONFLICT an empty name
Result<gltf::LoadOptions> choose_scene(const std::optional<std::string>& scene,
                                       const std::optional<std::string>& variant);

}  // namespace obscura::app
