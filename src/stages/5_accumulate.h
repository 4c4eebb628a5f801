// stages/5_accumulate.h - stage 5: contributions become samples, samples become pixel sums.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/lanes.h"
#include "stages/stages.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Adds the light of unoccluded shadow rays to their samples.
void add_shadow_light(int count,
                      const ShadowView& columns,
                      const uint8_t* occluded,
                      const SampleColumns& samples);

/// Adds every pixel's samples to its sum, one by one in sample order, so that the sum does not
/// depend on how a pixel's samples were cut into batches.
///
/// In      range: which of each pixel's samples these are, the next ones after those in `sums`
/// In/Out  samples: pixels * range.count, padded as stages/path_state.h says; sums: by pixel
/// Out     number of samples that were not finite; each is cleared, all four channels
uint64_t accumulate(int pixels,
                    const SampleRange& range,
                    const SampleColumns& samples,
                    PixelSum* sums);

/// Clears the samples that are not finite; returns how many.
uint64_t clear_nonfinite(int count, const SampleColumns& samples);

}  // namespace OBSCURA_ISA
}  // namespace obscura
