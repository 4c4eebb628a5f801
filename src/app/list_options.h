// app/list_options.h - the options that ask for many images of one asset.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/option_entry.h"
#include "session/view_sampling.h"

#include <string>
#include <vector>

namespace obscura {
struct RenderRequest;
}  // namespace obscura

namespace obscura::app {

struct RenderArguments;
struct SceneRun;

/// The texts of these options as they stood on the command line.
struct ListArguments {
    OptionText views, cameras, variants, turntable, manifest;
    ViewSampling sampling;  ///< of `obscura dataset`, which reads it

    bool is_asked() const {
        return views || cameras || variants || turntable || sampling.count > 0;
    }
};

/// The arguments of each scene of a command, which may have several.
///
/// Errors  64 E-USAGE a number in place of a scene
Result<std::vector<RenderArguments>> arguments_of_scenes(const RenderArguments& arguments);

/// Whether the options fit, where a command has several scenes: their files need names that tell
/// scenes apart.
///
/// Errors  64 E-USAGE-CONFLICT
Result<void> check_scenes(const std::vector<SceneRun>& runs);

/// Pattern of an image's file where no output is given: "helmet.{variant}.{view}.exr".
std::string listed_output(const RenderArguments& arguments);

/// The options that need others checked.
///
/// Errors  64 E-USAGE-CONFLICT
Result<void> complete_list(const RenderArguments& arguments, RenderRequest& request);

OptionGroup<RenderArguments, RenderRequest> list_group();

}  // namespace obscura::app
