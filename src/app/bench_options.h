// app/bench_options.h - the options of `obscura bench`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/bench_request.h"

namespace CLI {
class App;
}

namespace obscura {

/// Declares every option on the subcommand; parsing fills `arguments`, which must outlive it.
void add_bench_options(CLI::App& command, BenchArguments& arguments);

}  // namespace obscura
