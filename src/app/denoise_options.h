// app/denoise_options.h - the table of the options of `obscura denoise`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.h"
#include "app/denoise_request.h"

namespace obscura::app {

/// The subcommand; parsing fills `arguments`, which must outlive it.
Command denoise_command(DenoiseArguments& arguments);

}  // namespace obscura::app
