// app/denoise_command.h - the subcommand `obscura denoise`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/denoise_request.h"

namespace obscura::app {

/// Denoises a file and writes it; prints messages. Returns the exit code.
int run_denoise(const DenoiseArguments& arguments);

}  // namespace obscura::app
