// app/serve_options.h - the tables of the options of `obscura serve` and `obscura view`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.h"
#include "app/serve_request.h"

namespace obscura::app {

using ServeOptionGroup = OptionGroup<ServeArguments, ServeRequest>;

/// Those of both commands.
std::span<const ServeOptionGroup> serve_option_groups();

/// The subcommands; parsing fills `arguments`, which must outlive them.
Command serve_command(ServeArguments& arguments);
Command view_command(ServeArguments& arguments);

}  // namespace obscura::app
