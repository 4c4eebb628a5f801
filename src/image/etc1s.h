// image/etc1s.h - ETC1S blocks: one base colour, one table of brightness steps, 16 selectors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/texel_block.h"

#include <cstdint>

namespace obscura {

/// The colours of a block.
struct Etc1sEndpoint {
    uint8_t red = 0;  ///< 0 to 31, as are green and blue
    uint8_t green = 0;
    uint8_t blue = 0;
    uint8_t table = 0;  ///< of brightness steps, 0 to 7
};

/// Two bits a texel, the first texel's lowest: 0 the darkest, 3 the brightest.
using Etc1sSelectors = uint32_t;

/// The block's texels, opaque.
///
/// Source  Khronos Data Format 1.4, ETC1 (ETC1S is a subset)
TexelBlock decode_etc1s_block(const Etc1sEndpoint& endpoint, Etc1sSelectors selectors);

}  // namespace obscura
