// render/tile_sums.cpp - a tile's sums as bytes, block by block, and added to earlier ones.
// SPDX-License-Identifier: Apache-2.0
#include "render/tile.h"

#include <algorithm>
#include <array>

namespace obscura {

namespace {

/// Mostly one of the two parts of a sum is zero in all pixels.
void put_beauty(const std::vector<PixelSum>& sums, StateWriter& out) {
    std::vector<double> blocks;
    std::vector<std::array<float, 4>> latest(sums.size());
    for (size_t i = 0; i < sums.size(); ++i) {
        blocks.insert(blocks.end(), std::begin(sums[i].blocks), std::end(sums[i].blocks));
        std::copy_n(sums[i].block, 4, latest[i].begin());
    }
    out.put_doubles(blocks);
    out.put_unless_zero(latest);
}

void take_beauty(StateReader& in, std::vector<PixelSum>& sums) {
    std::vector<double> blocks(4 * sums.size());
    std::vector<std::array<float, 4>> latest(sums.size());
    in.take_doubles(blocks);
    in.take_unless_zero(latest);
    for (size_t i = 0; i < sums.size(); ++i) {
        std::copy_n(&blocks[4 * i], 4, sums[i].blocks);
        std::copy_n(latest[i].begin(), 4, sums[i].block);
    }
}

/// Adds the sum of a later block, if anything is in it.
void append(const PixelSum& later, PixelSum& sum) {
    if (std::all_of(std::begin(later.block), std::end(later.block), [](float c) { return c == 0; }))
        return;
    for (int c = 0; c < 4; ++c) {
        sum.blocks[c] += static_cast<double>(sum.block[c]);
        sum.block[c] = later.block[c];
    }
}

}  // namespace

void put_sums(const TileSums& sums, StateWriter& out) {
    put_beauty(sums.beauty, out);
    out.put_unless_zero(sums.catchers);
    sums.layers.put(out);
}

void take_sums(StateReader& in, TileSums& sums) {
    take_beauty(in, sums.beauty);
    in.take_unless_zero(sums.catchers);
    sums.layers.take(in);
}

void end_block(TileSums& sums, StateWriter& out) {
    put_beauty(sums.beauty, out);
    out.put_unless_zero(sums.catchers);
    sums.layers.end_block(out);
    std::fill(sums.beauty.begin(), sums.beauty.end(), PixelSum{});
    std::fill(sums.catchers.begin(), sums.catchers.end(), CatcherSum{});
}

void take_block(StateReader& in, TileSums& sums) {
    take_beauty(in, sums.beauty);
    in.take_unless_zero(sums.catchers);
    sums.layers.take_block(in);
}

void append(const TileSums& later, TileSums& sums) {
    for (size_t i = 0; i < sums.beauty.size(); ++i) {
        append(later.beauty[i], sums.beauty[i]);
        sums.samples[i] += later.samples[i];
    }
    for (size_t i = 0; i < sums.catchers.size(); ++i)
        sums.catchers[i].append(later.catchers[i]);
    sums.layers.append(later.layers);
}

}  // namespace obscura
