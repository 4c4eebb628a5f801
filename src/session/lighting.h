// session/lighting.h - reads or makes the environment that is asked for.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/render_request.h"

namespace obscura {

/// Reads or makes --env, if it was given.
///
/// Errors  67 E-ENV-*; those of parse_built_in_environment
Result<LightingOptions> load_lighting(const RenderRequest& request, Log& log);

}  // namespace obscura
