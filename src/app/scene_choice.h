// app/scene_choice.h - the option --scene, which several commands share.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "gltf/load.h"

#include <optional>
#include <string>

namespace obscura {

/// Digits alone are an index, anything else a name; empty: the file's default.
///
/// Errors  64 E-USAGE-RANGE an index too large for any file, 64 E-USAGE-CONFLICT an empty name
Result<LoadOptions> choose_scene(const std::optional<std::string>& text);

}  // namespace obscura
