// render/counts.h - counters of rays and faults: sums, differences, and as numbers of a file.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render.h"
#include "stages/wavefront.h"

#include <array>
#include <cstdint>

namespace obscura {

/// Adds counters without their times.
void add_counts(const WavefrontCounters& from, RenderCounters& to);
void add_counts(const RenderCounters& from, RenderCounters& to);

/// What a thread has counted since `before`, without times.
RenderCounters counted_since(const RenderCounters& before, const WavefrontCounters& now);

/// Counters as FilmStateHead has them.
std::array<uint64_t, 6> counters_in_file(const RenderCounters& counters);
RenderCounters counters_from_file(const std::array<uint64_t, 6>& counters);

}  // namespace obscura
