// app/crosscheck_command.h - the subcommand `obscura crosscheck`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/crosscheck_request.h"

namespace obscura::app {

/// Checks every scene, prints the tables and writes what was asked for. Returns the exit code: 1
/// when a scene is outside the budget.
int run_crosscheck(const CrosscheckArguments& arguments);

}  // namespace obscura::app
