// stages/pixel_sum.h - the sum of a pixel's samples, which does not lose small ones among many.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace obscura {

/// Samples of every pixel: [first, first + count).
struct SampleRange {
    uint32_t first = 0;
    int count = 0;
};

/// The first samples of a pixel are added one by one: so few lose little.
inline constexpr uint32_t first_sum_samples = 1024;

/// The others are added one by one in blocks that begin at every so many, and the blocks' sums in
/// double: a constant is then right to 5e-7 after 2^20 samples, where a single sum in float would
/// be 1.4 % off.
inline constexpr uint32_t sum_block_samples = 32;

static_assert(first_sum_samples % sum_block_samples == 0);

/// RGBA. Which samples are added to which block follows from their numbers alone, so that the sum
/// does not depend on how they were cut into batches.
struct PixelSum {
    double blocks[4] = {0, 0, 0, 0};  ///< of those that are finished
    float block[4] = {0, 0, 0, 0};    ///< of the one that is not

    /// Channel c of the mean of a pixel's first `samples` samples.
    float mean(int c, int samples) const {
        if (static_cast<uint32_t>(samples) <= first_sum_samples) {
            return block[c] * (1.0f / static_cast<float>(samples));
        }
        return static_cast<float>((blocks[c] + static_cast<double>(block[c])) / samples);
    }
};

}  // namespace obscura
