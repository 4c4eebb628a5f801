// film/catcher_sums.h - the light that the shadow catchers of a pixel received, and its alpha.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "film/block_sum.h"
#include "stages/catcher_work.h"

#include <array>
#include <span>
#include <vector>

namespace obscura {

/// Sums over the samples of a pixel that show a shadow catcher.
struct CatcherLight {
    double shadowed = 0;                              ///< luminance
    double unshadowed = 0;                            ///< likewise, with nothing in the way
    std::array<double, 4> background = {0, 0, 0, 0};  ///< premultiplied RGBA behind the catcher
    double transmitted = 0;  ///< by the clear glass in front of it; 1 a sample where there is none

    CatcherLight& operator+=(const CatcherLight& other);
};

/// The same, sample by sample.
using CatcherSum = BlockSum<CatcherLight>;

/// Adds the samples of a batch.
///
/// In      range: of the pixels' samples in the batch
/// In/Out  sums: of the batch's pixels
void add_catcher_samples(const std::vector<CatcherSample>& samples,
                         const SampleRange& range,
                         std::span<CatcherSum> sums);

/// The shadow's opacity: 1 - shadowed / unshadowed within [0, 1], so that laid over an image of the
/// lit catcher it gives the shadowed one. A ratio of sums: the mean of the samples' ratios would
/// weigh faint light as much as bright light. 0 where no light would arrive.
double shadow_alpha(const CatcherLight& sum);

/// What a pixel's catcher adds to the mean of all its samples: a black of shadow_alpha over what
/// lies behind, premultiplied RGBA.
///
/// In      samples: all of the pixel
std::array<float, 4> catcher_part(const CatcherLight& sum, int samples);

}  // namespace obscura
