// app/render_command.h - the subcommand `obscura render`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/render_request.h"

namespace obscura {

/// Renders one picture and writes it; prints what there is to say. Returns the exit code.
int run_render(const RenderArguments& arguments);

}  // namespace obscura
