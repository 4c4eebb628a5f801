// film/block_sum.h - a sum in double whose samples are added block by block, as those of PixelSum.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/pixel_sum.h"

#include <cstdint>

namespace obscura {

/// Samples are added to the block that their number belongs to, blocks to the sum of those before.
/// So one block's sum can be made apart and be appended later, to the same bits.
///
/// In      T: sums of doubles, with +=
template <typename T>
struct BlockSum {
    T blocks = {};        ///< of finished blocks
    T block = {};         ///< of the latest sample's block
    uint64_t number = 0;  ///< of that block

    /// Where to add a sample; their numbers ascend.
    T& block_of(uint64_t sample) {
        const uint64_t wanted = sample / sum_block_samples;
        if (wanted != number) append({{}, {}, wanted});
        return block;
    }
    /// Adds a later block.
    void append(const BlockSum& later) {
        blocks += block;
        block = later.block;
        number = later.number;
    }
    T total() const {
        T out = blocks;
        out += block;
        return out;
    }
};

}  // namespace obscura
