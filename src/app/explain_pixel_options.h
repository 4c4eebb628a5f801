// app/explain_pixel_options.h - the options of `obscura explain-pixel`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/explain_pixel_command.h"

namespace CLI {
class App;
}

namespace obscura {

/// Declares every option on the subcommand; parsing fills `arguments`, which must outlive it.
void add_explain_pixel_options(CLI::App& command, ExplainPixelArguments& arguments);

}  // namespace obscura
