// app/exposure_groups.h - --exposure auto: one exposure for the images of a group, metered first.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/render_command.h"

namespace obscura::app {

/// Meters the images of every group and gives their runs the exposure as a number, in the request
/// and in the options: from then on they are what `--exposure NUMBER` makes of them. Of each run up
/// to four images count, evenly spread over its whole list, whatever part of it will be rendered.
/// A run that cannot be metered is left out; it will say why when it is rendered.
///
/// In, out   kept: what was metered stays open where there is memory
void meter_exposures(std::vector<SceneRun>& runs, KeptForLater& kept, Log& log);

}  // namespace obscura::app
