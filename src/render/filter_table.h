// render/filter_table.h - reconstruction filters as tables for the camera stage.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render.h"

#include <vector>

namespace obscura {

/// Offsets in pixels at equal steps of the filter's cumulative distribution, filter_entries + 1 of
/// them; empty for the box filter of one pixel.
///
/// gaussian: standard deviation 0.5, cut at 1.5 pixels. blackman_harris: four-term window,
/// 1.65 pixels to each side.
/// Source  Harris, "On the use of windows for harmonic analysis", Proc. IEEE 66(1), 1978
std::vector<float> make_filter_table(PixelFilter filter);

}  // namespace obscura
