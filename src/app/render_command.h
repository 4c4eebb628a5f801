// app/render_command.h - the subcommand `obscura render`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/render_request.h"

namespace obscura::app {

/// Renders one image and writes it; prints messages. Returns the exit code.
int run_render(const RenderArguments& arguments);

}  // namespace obscura::app
