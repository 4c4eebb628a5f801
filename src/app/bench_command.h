// app/bench_command.h - the subcommand `obscura bench`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/bench_request.h"

namespace obscura::app {

/// Measures every scene and view, prints the tables and writes what was asked for. Returns the
/// exit code.
int run_bench(const BenchArguments& arguments);

}  // namespace obscura::app
