// scene/wide_mip_chain.cpp - mip chains of 16-bit textures, whose bytes lie in two planes.
// SPDX-License-Identifier: Apache-2.0
#include "base/parallel.h"
#include "scene/texel_span.h"
#include "scene/texture_arena.h"
#include "surface/texture.h"

#include <algorithm>
#include <cstddef>

namespace obscura {
namespace {

struct WideLevel {
    uint32_t* high;
    uint32_t* low;
    int width;
    int height;

    size_t texels() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }
    size_t at(int x, int y) const {
        return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
    }
};

uint32_t code_of(float value) {
    return static_cast<uint32_t>(std::clamp(value, 0.0f, 1.0f) * 65535.0f + 0.5f);
}

void write_texel(const WideLevel& to, size_t at, const Rgba<float>& value, bool srgb) {
    const auto color = [&](float c) { return code_of(srgb ? srgb_from_linear(c) : c); };
    const uint32_t codes[4] = {
        color(value.rgb.x), color(value.rgb.y), color(value.rgb.z), code_of(value.alpha)};
    uint32_t high = 0, low = 0;
    for (int c = 0; c < 4; ++c) {
        high |= codes[c] >> 8 << (8 * c);
        low |= (codes[c] & 255U) << (8 * c);
    }
    to.high[at] = high;
    to.low[at] = low;
}

/// The mean under one texel, as mean_of_data and mean_of_colors of 8-bit texels.
Rgba<float> mean_under(const WideLevel& from,
                       const TexelSpan& columns,
                       const TexelSpan& rows,
                       bool srgb) {
    Rgba<float> plain{splat3(0.0f), 0.0f};
    Vec3<float> by_alpha = splat3(0.0f);
    for (int r = 0; r < rows.count; ++r) {
        for (int c = 0; c < columns.count; ++c) {
            const size_t at = from.at(columns.first + c, rows.first + r);
            const Rgba<float> texel = decode_wide_texel<float>(from.high[at], from.low[at], srgb);
            const float weight = rows.weight[r] * columns.weight[c];
            add_texel(texel, weight, plain);
            by_alpha = by_alpha + texel.rgb * (weight * texel.alpha);
        }
    }
    if (srgb && plain.alpha > 0.0f) plain.rgb = by_alpha * (1.0f / plain.alpha);
    return plain;
}

void halve_rows(const WideLevel& from, const WideLevel& to, bool srgb, int begin, int end) {
    for (int y = begin; y < end; ++y) {
        const TexelSpan rows = span_under(y, from.height, to.height);
        for (int x = 0; x < to.width; ++x) {
            const TexelSpan columns = span_under(x, from.width, to.width);
            write_texel(to, to.at(x, y), mean_under(from, columns, rows, srgb), srgb);
        }
    }
}

}  // namespace

void build_wide_mip_chain(uint32_t* base, uint32_t* low, int width, int height, bool srgb) {
    WideLevel from{base, low, width, height};
    while (from.width > 1 || from.height > 1) {
        const WideLevel to{from.high + from.texels(),
                           from.low + from.texels(),
                           std::max(from.width >> 1, 1),
                           std::max(from.height >> 1, 1)};
        parallel_ranges(static_cast<size_t>(to.height), 16, [&](size_t begin, size_t end) {
            halve_rows(from, to, srgb, static_cast<int>(begin), static_cast<int>(end));
        });
        from = to;
    }
}

}  // namespace obscura
