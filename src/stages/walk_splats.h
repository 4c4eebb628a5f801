// stages/walk_splats.h - Gaussian splats on the way of paths and of shadow rays.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/walk.h"

namespace obscura {

/// Between stages 2 and 3: adds the light of the splats that the paths pass before their hits, and
/// takes from the paths what these hold back. Paths that nothing passes end.
///
/// In   camera: they are the camera's rays, whose samples become as opaque as the splats are
void pass_splats(const WalkInput& in, int count, bool camera, Workspace& work, WalkCounters& c);

/// Stage 4: takes from shadow rays what splats hold back.
void dim_shadows(const WalkInput& in,
                 const RayColumns& rays,
                 Workspace& work,
                 WalkCounters& counters);

}  // namespace obscura
