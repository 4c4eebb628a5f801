// app/memory_option.h - `--max-memory`, `--texture-memory`: sizes, and the memory budget.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/memory_limit.h"
#include "session/render_request.h"

#include <optional>
#include <string>

namespace obscura::app {

/// "512M", "4G", "1.5G", "80%" or a number of bytes; K, M, G and T are powers of 1024, with or
/// without a B or an iB behind them.
///
/// Errors  64 E-USAGE-NUMBER, E-USAGE-RANGE: less than 1 MiB, a share not in (0, 100]
Result<MemorySize> parse_memory_size(const std::string& text, const std::string& option);

/// Sets the budget: what was asked for, else 80 % of the least of the limits that the process has.
///
/// In      bound: of memory_bound
/// Errors  33 E-MEM the program itself does not fit
Result<void> use_memory_limit(const std::optional<MemorySize>& asked, const MemoryBound& bound);

/// Starts the threads of the calling thread's ThreadLimit where the address space is limited
/// (ulimit -v), from the second call on nothing: one that has no addresses for its stack later on
/// would end the process without a word.
///
/// Errors  33 E-MEM they have none
Result<void> start_threads_ahead();

/// Sets LoadOptions::texture_limit by --texture-memory and --texture-cache. Touches no file.
///
/// Errors  64 E-USAGE-CONFLICT the user has no folder for caches, and none is given
Result<void> complete_texture_limit(RenderRequest& request);

}  // namespace obscura::app
