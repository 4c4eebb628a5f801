// scene/texel_colors.cpp - converts the colours of texels to another rendering space.
// SPDX-License-Identifier: Apache-2.0
#include "scene/texel_colors.h"

#include "base/parallel.h"
#include "image/rendering_space.h"
#include "surface/texture.h"

#include <algorithm>
#include <span>

namespace obscura {

namespace {

/// The inverse of linear_from_srgb16, whose straight lines between 8-bit codes it follows.
uint32_t srgb16_from_linear(float linear) {
    const float inside = std::clamp(linear, 0.0f, 1.0f);
    const auto& table = srgb_to_linear_table;
    const auto* above = std::upper_bound(table + 1, table + 255, inside);
    const float step = *above - above[-1];
    const auto below = static_cast<float>(above - 1 - table);
    return static_cast<uint32_t>((below + (inside - above[-1]) / step) * 257.0f + 0.5f);
}

}  // namespace

void convert_texels(const Matrix3& matrix, uint32_t* high, uint32_t* low, size_t count) {
    constexpr size_t grain = 1U << 14;
    constexpr uint32_t alpha = 0xFF000000U;
    const MaskOf<float> srgb = true;
    parallel_ranges(count, grain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const Vec3f color = decode_wide_texel<float>(high[i], low[i], srgb).rgb;
            float rgb[3] = {color.x, color.y, color.z};
            convert_colors(matrix, rgb);
            high[i] &= alpha;
            low[i] &= alpha;
            for (int c = 0; c < 3; ++c) {
                const uint32_t code = srgb16_from_linear(rgb[c]);
                high[i] |= code >> 8 << (8 * c);
                low[i] |= (code & 255U) << (8 * c);
            }
        }
    });
}

}  // namespace obscura
