// app/render_options.h - the options of `obscura render` and the help a person can work from.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/render_request.h"

namespace CLI {
class App;
}

namespace obscura {

/// Declares every option on the subcommand; parsing fills `arguments`, which must outlive it.
void add_render_options(CLI::App& command, RenderArguments& arguments);

/// Options that other subcommands share: --spp to --ao-distance, --camera to --camera-model,
/// --env to --env-rotation, --strict and --lenient.
void add_sampling_options(CLI::App& command,
                          RenderArguments& arguments,
                          const std::string& default_spp);
void add_camera_options(CLI::App& command, RenderArguments& arguments);
void add_light_options(CLI::App& command, RenderArguments& arguments);
void add_fault_options(CLI::App& command, RenderArguments& arguments);

}  // namespace obscura
