// stages/wavefront_splats.h - Gaussian splats along path segments and shadow rays.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/wavefront.h"

namespace obscura {

/// Between stages 2 and 3: adds the light of the splats before the paths' hits, and attenuates the
/// paths by them. Paths without transmittance end.
///
/// In   bounce: 0 for camera rays, whose samples take the splats' opacity
void pass_splats(
    const WavefrontInput& in, int count, int bounce, Workspace& work, WavefrontCounters& c);

/// Stage 4: attenuates shadow rays by the splats that they pass.
void dim_shadows(const WavefrontInput& in,
                 const RayColumns& rays,
                 Workspace& work,
                 WavefrontCounters& counters);

}  // namespace obscura
