// session/lighting.h - reads the environment map of the command line.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/render_request.h"

namespace obscura {

/// Reads --env, if it was given.
///
/// Errors  67 E-ENV-*
Result<LightingOptions> load_lighting(const RenderRequest& request, Log& log);

}  // namespace obscura
