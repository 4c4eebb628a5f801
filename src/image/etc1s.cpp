// image/etc1s.cpp - decodes ETC1S blocks to texels.
// SPDX-License-Identifier: Apache-2.0
#include "image/etc1s.h"

#include <algorithm>
#include <array>

namespace obscura {

namespace {

/// Steps that are added to all three channels, by table and selector.
constexpr int brightness_steps[8][4] = {{-8, -2, 2, 8},
                                        {-17, -5, 5, 17},
                                        {-29, -9, 9, 29},
                                        {-42, -13, 13, 42},
                                        {-60, -18, 18, 60},
                                        {-80, -24, 24, 80},
                                        {-106, -33, 33, 106},
                                        {-183, -47, 47, 183}};

uint32_t channel(uint8_t base, int step) {
    const int eight_bits = base << 3 | base >> 2;
    return static_cast<uint32_t>(std::clamp(eight_bits + step, 0, 255));
}

}  // namespace

TexelBlock decode_etc1s_block(const Etc1sEndpoint& endpoint, Etc1sSelectors selectors) {
    std::array<uint32_t, 4> colors = {};
    for (size_t i = 0; i < colors.size(); ++i) {
        const int step = brightness_steps[endpoint.table & 7U][i];
        colors[i] = channel(endpoint.red, step) | channel(endpoint.green, step) << 8 |
                    channel(endpoint.blue, step) << 16 | 0xFF000000U;
    }
    TexelBlock texels;
    for (size_t i = 0; i < texels.size(); ++i)
        texels[i] = colors[selectors >> 2 * i & 3U];
    return texels;
}

}  // namespace obscura
