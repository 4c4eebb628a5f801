// app/explain_pixel_options.h - the table of the options of `obscura explain-pixel`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.h"
#include "app/explain_pixel_command.h"

namespace obscura::app {

/// The command's own options.
std::span<const OptionGroup<ExplainPixelArguments, ExplainRequest>> explain_pixel_option_groups();

/// The subcommand; parsing fills `arguments`, which must outlive it.
Command explain_pixel_command(ExplainPixelArguments& arguments);

}  // namespace obscura::app
