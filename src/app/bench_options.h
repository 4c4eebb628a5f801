// app/bench_options.h - the table of the options of `obscura bench`.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/bench_request.h"
#include "app/command.h"

namespace obscura::app {

/// The bench's own options.
std::span<const OptionGroup<BenchArguments, BenchRequest>> bench_option_groups();

/// The subcommand; parsing fills `arguments`, which must outlive it.
Command bench_command(BenchArguments& arguments);

}  // namespace obscura::app
