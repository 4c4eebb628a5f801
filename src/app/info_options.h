// app/info_options.h - the table of the options of `obscura info`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.h"
#include "app/info_command.h"

namespace obscura::app {

/// The subcommand; parsing fills `arguments`, which must outlive it.
Command info_command(InfoArguments& arguments);

}  // namespace obscura::app
