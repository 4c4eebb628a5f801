// stages/catcher_work.h - the camera rays of a batch that hit shadow catchers, and their light.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/path_state.h"

#include <cstddef>
#include <vector>

namespace obscura {

/// What one sample of a shadow catcher received: luminance, and what lies behind the catcher.
struct CatcherSample {
    uint32_t slot = 0;                   ///< sample index
    float shadowed = 0;                  ///< with all surfaces in place
    float unshadowed = 0;                ///< from the same light samples, with nothing in their way
    float background[4] = {0, 0, 0, 0};  ///< premultiplied RGBA
};

/// Columns for the camera rays of one batch that hit catchers.
struct CatcherWork {
    std::vector<CatcherSample> samples;  ///< of the latest batch, in the order of sample indices
    std::vector<int32_t> by_slot;        ///< index in `samples`; read only where there is one
    PathColumns paths;
    HitColumns hits;
    PathColumns reflections;
    int reflection_count = 0;
    std::vector<std::byte> memory;
};

}  // namespace obscura
