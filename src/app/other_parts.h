// app/other_parts.h - files of renderings that other parts of a command make.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/render_command.h"
#include "app/render_job.h"

namespace obscura::app {

/// Notes the files of renderings of other parts, as the whole command would: one that comes before
/// a rendering of this part has their names. Only assets whose names may be those of this part are
/// opened; of those that fail, their own part tells.
///
/// In, out  kept: written
void note_files_of_other_parts(const std::vector<SceneRun>& runs, KeptForLater& kept);

}  // namespace obscura::app
