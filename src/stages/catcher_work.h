// stages/catcher_work.h - the camera rays of a batch that hit shadow catchers, and their light.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/path_state.h"

#include <cstddef>
#include <vector>

namespace obscura {

/// What one sample of a shadow catcher received: luminance, and what lies behind the catcher. All
/// of it as seen through the clear glass in front of the catcher, if there is any.
struct CatcherSample {
    uint32_t slot = 0;                   ///< sample index
    float shadowed = 0;                  ///< with all surfaces in place
    float unshadowed = 0;                ///< from the same light samples, with nothing in their way
    float background[4] = {0, 0, 0, 0};  ///< premultiplied RGBA
    float transmitted = 1;               ///< by clear glass, the mean of its channels
    float front[3] = {0, 0, 0};          ///< light that came to the sample before the catcher
};

/// Reflections of the catchers that paths met at one bounce: a range of them.
struct CatcherReflections {
    int bounce = 0;
    int first = 0, count = 0;
};

/// Columns for the paths of one batch that met catchers, and what came of it.
struct CatcherWork {
    std::vector<CatcherSample> samples;  ///< of the latest batch, in the order of sample indices
    std::vector<int32_t> by_slot;        ///< index in `samples`; read only where there is one
    int first = 0;                       ///< in `samples`, of those met at the latest bounce
    PathColumns paths;                   ///< of the latest bounce
    HitColumns hits;                     ///< likewise
    PathColumns reflections;             ///< of all bounces
    std::vector<CatcherReflections> reflected;
    std::vector<int32_t> clear;  ///< paths of this bounce that met nothing but clear glass
    std::vector<int32_t> ended;  ///< those of them that end at a catcher or the background
    std::vector<std::byte> memory;
};

}  // namespace obscura
