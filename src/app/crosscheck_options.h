// app/crosscheck_options.h - the options of `obscura crosscheck`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/crosscheck_request.h"

namespace CLI {
class App;
}

namespace obscura {

/// Adds them to the subcommand; the texts arrive in `arguments`.
void add_crosscheck_options(CLI::App& command, CrosscheckArguments& arguments);

}  // namespace obscura
