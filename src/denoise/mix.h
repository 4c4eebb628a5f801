// denoise/mix.h - which filtered image is best at each pixel.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "denoise/candidates.h"

namespace obscura {

/// Estimates each filter's error at each pixel, and mixes them by it. The squared bias is the mean
/// of the product of what the filter changes in either half, whose noise is independent; the
/// variance is what the two filtered halves differ by. An unfiltered pixel has variance alone.
Mix mix_candidates(const FilterGuides& guides, const Candidates& candidates);

}  // namespace obscura
