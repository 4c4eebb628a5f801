// scene/texture_arena.cpp - makes mip chains: exact box means, in linear light for colours.
// SPDX-License-Identifier: Apache-2.0
#include "scene/texture_arena.h"

#include "base/parallel.h"
#include "scene/texel_span.h"
#include "surface/srgb.h"

#include <algorithm>
#include <cstddef>

namespace obscura {
namespace {

/// Texels that one texel of the next level covers, with weights that sum to 1. N is 4 for two by
/// two; 9 holds every case (a side 2n + 1 becomes n, so 2 + 1/n texels), unused ones weigh 0.
template <int N>
struct Cover {
    uint32_t texel[N];
    float weight[N];
};

/// Mean of each of the four bytes: for data such as normals, roughness or metalness.
template <int N>
uint32_t mean_of_data(const Cover<N>& cover) {
    if constexpr (N == 4) {  // two bytes at a time; the sums of four need ten of sixteen bits
        uint32_t even = 0x00020002U, odd = 0x00020002U;
        for (const uint32_t texel : cover.texel) {
            even += texel & 0x00FF00FFU;
            odd += texel >> 8 & 0x00FF00FFU;
        }
        return (even >> 2 & 0x00FF00FFU) | (odd >> 2 & 0x00FF00FFU) << 8;
    } else {
        uint32_t mean = 0;
        for (int shift = 0; shift < 32; shift += 8) {
            float sum = 0.5f;
            for (int i = 0; i < N; ++i) {
                sum += cover.weight[i] * static_cast<float>(cover.texel[i] >> shift & 0xFFU);
            }
            mean |= std::min(static_cast<uint32_t>(sum), 255U) << shift;
        }
        return mean;
    }
}

/// Mean of sRGB texels in linear light, weighted by alpha unless all are clear; alpha plainly.
template <int N>
uint32_t mean_of_colors(const Cover<N>& cover) {
    float weight[N];
    float alpha = 0.0f;
    for (int i = 0; i < N; ++i) {
        weight[i] = cover.weight[i] * static_cast<float>(cover.texel[i] >> 24);
        alpha += weight[i];
    }
    const bool clear = alpha == 0.0f;
    float red = 0.0f, green = 0.0f, blue = 0.0f, total = 0.0f;
    for (int i = 0; i < N; ++i) {
        const float w = clear ? cover.weight[i] : weight[i];
        red += w * srgb_to_linear_table[cover.texel[i] & 0xFFU];
        green += w * srgb_to_linear_table[cover.texel[i] >> 8 & 0xFFU];
        blue += w * srgb_to_linear_table[cover.texel[i] >> 16 & 0xFFU];
        total += w;
    }
    const float scale = 1.0f / total;
    return static_cast<uint32_t>(srgb8_from_linear(red * scale)) |
           static_cast<uint32_t>(srgb8_from_linear(green * scale)) << 8 |
           static_cast<uint32_t>(srgb8_from_linear(blue * scale)) << 16 |
           std::min(static_cast<uint32_t>(alpha + 0.5f), 255U) << 24;
}

template <int N>
uint32_t mean_of(const Cover<N>& cover, bool srgb) {
    return srgb ? mean_of_colors(cover) : mean_of_data(cover);
}

struct Level {
    uint32_t* texels;
    int width;
    int height;
};

/// Row y of `to`, where both sides of `from` are even.
template <bool Srgb>
void halve_even_row(const Level& from, const Level& to, int y) {
    const uint32_t* top =
        from.texels + static_cast<size_t>(2 * y) * static_cast<size_t>(from.width);
    const uint32_t* bottom = top + from.width;
    uint32_t* out = to.texels + static_cast<size_t>(y) * static_cast<size_t>(to.width);
    for (int x = 0; x < to.width; ++x) {
        const Cover<4> cover{{top[2 * x], top[2 * x + 1], bottom[2 * x], bottom[2 * x + 1]},
                             {0.25f, 0.25f, 0.25f, 0.25f}};
        out[x] = mean_of(cover, Srgb);
    }
}

/// Row y of `to` in every other case.
void halve_any_row(const Level& from, const Level& to, int y, bool srgb) {
    const TexelSpan rows = span_under(y, from.height, to.height);
    uint32_t* out = to.texels + static_cast<size_t>(y) * static_cast<size_t>(to.width);
    for (int x = 0; x < to.width; ++x) {
        const TexelSpan columns = span_under(x, from.width, to.width);
        Cover<9> cover{};
        for (int r = 0; r < rows.count; ++r) {
            const uint32_t* row =
                from.texels + static_cast<size_t>(rows.first + r) * static_cast<size_t>(from.width);
            for (int c = 0; c < columns.count; ++c) {
                cover.texel[3 * r + c] = row[columns.first + c];
                cover.weight[3 * r + c] = rows.weight[r] * columns.weight[c];
            }
        }
        out[x] = mean_of(cover, srgb);
    }
}

void halve_rows(const Level& from, const Level& to, bool srgb, size_t begin, size_t end) {
    const bool even = from.width % 2 == 0 && from.height % 2 == 0;
    for (size_t row = begin; row < end; ++row) {
        const auto y = static_cast<int>(row);
        if (!even) {
            halve_any_row(from, to, y, srgb);
        } else if (srgb) {
            halve_even_row<true>(from, to, y);
        } else {
            halve_even_row<false>(from, to, y);
        }
    }
}

}  // namespace

int mip_level_count(int width, int height) {
    int levels = 1;
    for (int side = std::max(width, height); side > 1; side >>= 1)
        ++levels;
    return levels;
}

size_t mip_chain_texels(int width, int height) {
    size_t texels = 0;
    const int levels = mip_level_count(width, height);
    for (int level = 0; level < levels; ++level) {
        texels += static_cast<size_t>(std::max(width >> level, 1)) *
                  static_cast<size_t>(std::max(height >> level, 1));
    }
    return texels;
}

std::span<const uint32_t> texels_of(const TextureArena& textures) {
    if (textures.mapped == nullptr) return textures.texels;
    return {textures.mapped->data(), textures.mapped->size()};
}

TextureView view_of(const TextureArena& textures) {
    const auto has_low_plane = [](const TextureRecord& record) { return record.low_plane != 0; };
    return {texels_of(textures).data(),
            textures.records.data(),
            std::any_of(textures.records.begin(), textures.records.end(), has_low_plane)};
}

float texel_channel(const TextureArena& textures,
                    const TextureRecord& record,
                    size_t texel,
                    int channel) {
    const std::span<const uint32_t> texels = texels_of(textures);
    const auto byte = [&](size_t at) { return texels[at] >> (8 * channel) & 255U; };
    const uint32_t high = byte(texel);
    if (record.low_plane == 0) return static_cast<float>(high) / 255.0f;
    const uint32_t low = byte(texel + static_cast<size_t>(record.low_plane));
    return static_cast<float>(high << 8 | low) / 65535.0f;
}

void build_mip_chain(uint32_t* base, int width, int height, bool srgb) {
    constexpr size_t texels_worth_a_task = 1U << 15;
    Level from{base, width, height};
    while (from.width > 1 || from.height > 1) {
        const size_t texels = static_cast<size_t>(from.width) * static_cast<size_t>(from.height);
        const Level to{
            from.texels + texels, std::max(from.width >> 1, 1), std::max(from.height >> 1, 1)};
        const auto rows = static_cast<size_t>(to.height);
        const size_t rows_per_task =
            std::max<size_t>(texels_worth_a_task / static_cast<size_t>(to.width), 1);
        if (rows <= rows_per_task) {
            halve_rows(from, to, srgb, 0, rows);
        } else {
            parallel_ranges(rows, rows_per_task, [&](size_t begin, size_t end) {
                halve_rows(from, to, srgb, begin, end);
            });
        }
        from = to;
    }
}

}  // namespace obscura
