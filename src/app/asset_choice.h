// app/asset_choice.h - which scenes a measuring command looks at when none is given.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <optional>
#include <string>
#include <vector>

namespace obscura {

/// The scenes that were given; else all of a folder, or of `assets` beside the program or above it.
///
/// Errors  67 E-BENCH-ASSETS
Result<std::vector<std::string>> scenes_or_assets(const std::vector<std::string>& scenes,
                                                  const std::optional<std::string>& assets);

}  // namespace obscura
