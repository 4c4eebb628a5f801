// session/lighting.h - the light that the command line brings to a scene.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/render_request.h"

namespace obscura {

/// Reads --env, if it was given.
///
/// Errors  67 E-ENV-*
Result<LightingOptions> load_lighting(const RenderRequest& request, Log& log);

}  // namespace obscura
