// app/render_command.h - the subcommand `obscura render`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/option_places.h"
#include "app/render_job.h"
#include "app/render_request.h"

#include <functional>
#include <string>
#include <vector>

namespace obscura::app {

/// Renders one image and writes it; prints messages. Returns the exit code.
///
/// In      parts: the pixels come from there; null: they are rendered
int run_render(const RenderArguments& arguments, const ImageParts* parts);

/// One scene of a command, or one rendering of a job.
struct SceneRun {
    RenderRequest request;
    NamedTexts options;                 ///< as they were given: see options_for_merge
    const ImageParts* parts = nullptr;  ///< where pixels come from; null: they are rendered
    ImageHooks hooks = {};
    OptionPlaces places = {};         ///< in a job
    bool is_of_another_part = false;  ///< of the command: only metered for --exposure auto
};

/// Renders one after the other and prints messages; one that fails does not end the rest, unless
/// the program is to stop. Returns the exit code.
///
/// In      runs: one at least, not all of another part; where: what the closing line
///         names; finish: done after the last, also after failures, unless the program is to stop
int run_scenes(
    std::vector<SceneRun>& runs,
    const std::string& where,
    Log& log,
    const std::function<Result<void>()>& finish = [] { return Result<void>(); });

}  // namespace obscura::app
