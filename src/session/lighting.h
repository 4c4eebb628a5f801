// session/lighting.h - reads or makes the environment that is asked for.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/render_request.h"

#include <memory>

namespace obscura {

/// Reads or makes --env, if it was given.
///
/// In      environment: what an earlier request with the same one has got; null: nothing
/// Errors  67 E-ENV-*; those of parse_built_in_environment; 33 E-MEM
Result<LightingOptions> load_lighting(const RenderRequest& request,
                                      Log& log,
                                      std::shared_ptr<const ImageRgb32f> environment = {});

/// The angle about +Y, counter-clockwise seen from above, by which a camera in front (+Z) must turn
/// to stand where this one does: its azimuth, in degrees. Of one that looks straight up or down, by
/// its right side.
double camera_azimuth_deg(const Affined& world_from_camera);

}  // namespace obscura
