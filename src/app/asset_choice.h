// app/asset_choice.h - which scenes a measuring command looks at when none is given.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/option_row.h"
#include "app/render_request.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace obscura {

/// A request for each of the scenes that were given; else for all of a folder, or of `assets`
/// beside the program or above it.
///
/// Errors  67 E-BENCH-ASSETS, those of request_for
Result<std::vector<RenderRequest>> requests_for(
    const std::vector<std::string>& scenes,
    const std::optional<std::string>& assets,
    const std::function<Result<RenderRequest>(const std::string&)>& request_for);

inline constexpr OptionInfo assets_option = {
    .name = "--assets",
    .argument = "DIR",
    .help = "Where to look for scenes when none is given",
    .fallback = "the folder assets beside the program or above it",
    .files = "/",
    .excludes = {"SCENE"}};

}  // namespace obscura
