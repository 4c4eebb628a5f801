// app/before_its_turn.h - does something with a rendering before its turn, without a word.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/render_command.h"
#include "app/render_job.h"

#include <functional>

namespace obscura::app {

/// Does something with a job before its turn, with the threads and the memory that it will have.
/// Messages are kept back, for its own turn will give them; what is opened stays open where there
/// is memory. Does it once more where memory lacks that is kept for later.
///
/// In, out  kept: of the command
/// Errors   those of act; of threads, memory and files that options name
Result<void> do_before_its_turn(const SceneRun& run,
                                KeptForLater& kept,
                                const std::function<Result<void>(Job&)>& act);

}  // namespace obscura::app
