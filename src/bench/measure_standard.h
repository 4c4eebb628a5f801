// bench/measure_standard.h - renders the standard's scenes in rounds until the score is steady.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"
#include "bench/standard_scenes.h"
#include "bench/standard_score.h"

#include <atomic>

namespace obscura::bench {

/// How the standard is measured; other values than these are for tests.
struct StandardTask {
    Isa isa = Isa::automatic;
    int threads = 0;  ///< as limited by the caller
    int width = standard_width;
    int height = standard_height;
    int samples_per_pixel = standard_samples;
    /// Each round has a seed of its own. The noise is that of the first ones, so that it does not
    /// depend on how many rounds there are.
    int min_rounds = 8;
    int max_rounds = 24;
};

/// Renders each scene once to warm up, then all of them in turn, round by round.
///
/// Errors  75 E-STOPPED; 33 E-MEM; 69 E-ISA
Result<StandardReport> measure_standard(const StandardTask& task,
                                        const std::atomic<bool>& stop,
                                        Log& log);

}  // namespace obscura::bench
