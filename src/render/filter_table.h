// render/filter_table.h - pixel reconstruction filters as inverse cumulative distributions.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render.h"

#include <vector>

namespace obscura {

/// Offsets in pixels at filter_entries + 1 equal steps of the filter's cumulative distribution;
/// empty for the box filter of one pixel.
///
/// gaussian: standard deviation 0.5, cut at 1.5 pixels. blackman_harris: four-term window,
/// 1.65 pixels to each side.
/// Source  Harris, "On the use of windows for harmonic analysis", Proc. IEEE 66(1), 1978
std::vector<float> make_filter_table(PixelFilter filter);

}  // namespace obscura
