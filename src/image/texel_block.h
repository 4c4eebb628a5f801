// image/texel_block.h - blocks of 4 x 4 texels, and writing them into mip levels.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace obscura {

inline constexpr int block_side = 4;

/// 16 texels, rows from the top; R in the lowest byte.
using TexelBlock = std::array<uint32_t, size_t{block_side} * block_side>;

/// One mip level somewhere in memory.
struct TexelLevel {
    uint32_t* texels = nullptr;
    int width = 0;
    int height = 0;

    int block_columns() const { return (width + block_side - 1) / block_side; }
    int block_rows() const { return (height + block_side - 1) / block_side; }
    size_t block_count() const {
        return static_cast<size_t>(block_columns()) * static_cast<size_t>(block_rows());
    }
};

/// Writes the part of a block that lies inside the level; bits outside `mask` stay as they are.
inline void write_block(
    const TexelLevel& level, int column, int row, const TexelBlock& block, uint32_t mask) {
    const int width = std::min(block_side, level.width - block_side * column);
    const int height = std::min(block_side, level.height - block_side * row);
    for (int y = 0; y < height; ++y) {
        const ptrdiff_t line = ptrdiff_t{block_side} * row + y;
        uint32_t* out = level.texels + line * level.width + ptrdiff_t{block_side} * column;
        const uint32_t* from = &block[static_cast<size_t>(y) * block_side];
        for (int x = 0; x < width; ++x) {
            const uint32_t texel = from[x];
            out[x] = (out[x] & ~mask) | (texel & mask);
        }
    }
}

}  // namespace obscura
