// app/asset_choice.h - chooses the scenes of a measuring command.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/option_entry.h"
#include "app/render_request.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace obscura::app {

/// A request for each scene that was given; else for all in a folder, or in `assets` beside the
/// program or above it.
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
    .fallback = "the folder assets beside the program or above it, or as installed",
    .files = "/",
    .excludes = {"SCENE"}};

}  // namespace obscura::app
