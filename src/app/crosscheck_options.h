// app/crosscheck_options.h - the table of the options of `obscura crosscheck`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.h"
#include "app/crosscheck_request.h"

namespace obscura::app {

/// The command's own options.
std::span<const OptionGroup<CrosscheckArguments, CrosscheckRequest>> crosscheck_option_groups();

/// The subcommand; parsing fills `arguments`, which must outlive it.
Command crosscheck_command(CrosscheckArguments& arguments);

}  // namespace obscura::app
