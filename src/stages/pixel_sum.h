// stages/pixel_sum.h - sums a pixel's samples in blocks, so that rounding stays small.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace obscura {

/// Samples of every pixel: [first, first + count).
struct SampleRange {
    uint32_t first = 0;
    int count = 0;
};

/// Samples are added in blocks of this size, one by one; the blocks are summed in double. A
/// constant is then right to 5e-7 after 2^20 samples, where a single sum in float is 1.4 % off. All
/// sums of a film have these blocks, so that those of some blocks can be made apart and be added
/// later, in their order: see samples_of_part.
inline constexpr uint32_t sum_block_samples = 16;

/// Above this a sample counts as not finite: the sum of a pixel's samples must stay finite too.
inline constexpr float largest_sample = 1.0e30f;

/// RGBA sum of a pixel. A sample's block follows from its index alone, so that the sum does not
/// depend on how samples are cut into batches.
struct PixelSum {
    double blocks[4] = {0, 0, 0, 0};  ///< sums of finished blocks
    float block[4] = {0, 0, 0, 0};    ///< sum of the block in progress

    /// Channel c of the mean of a pixel's first `samples` samples.
    float mean(int c, int samples) const {
        if (static_cast<uint32_t>(samples) <= sum_block_samples) {
            return block[c] * (1.0f / static_cast<float>(samples));
        }
        return static_cast<float>((blocks[c] + static_cast<double>(block[c])) / samples);
    }
};

}  // namespace obscura
