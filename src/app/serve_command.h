// app/serve_command.h - the subcommands `obscura serve` and `obscura view`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/serve_request.h"

namespace obscura::app {

/// Serves until a signal comes; prints messages. Returns the exit code.
int run_serve(const ServeArguments& arguments);

/// The same for one model, which a browser is told to show.
int run_view(const ServeArguments& arguments);

}  // namespace obscura::app
