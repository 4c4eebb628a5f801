// render/tile.h - a tile of the film: its pixels, the sums over their samples, and how they grow.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "film/catcher_sums.h"
#include "film/film.h"
#include "film/layer_sums.h"
#include "render/render.h"
#include "stages/wavefront.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace obscura {

/// One tile of the film.
struct Tile {
    int x = 0, y = 0, width = 0, height = 0;
    bool operator==(const Tile&) const = default;
};

/// Cuts an area into tiles of at most size x size pixels, in the order of a Z-shaped curve.
std::vector<Tile> cut_tiles(const PixelRect& area, int size);

/// Order of a tile's pixels: 4x4 blocks, row by row within a block, so that packets of 16 rays are
/// square.
struct TilePattern {
    int width = 0, height = 0;
    std::vector<int32_t> dx, dy;  ///< from the tile's corner
    std::vector<uint32_t> all;    ///< 0, 1, 2, ...: every pixel
};

/// Sums over the samples of a tile's pixels, in the order of its pattern. They may grow in several
/// steps, of some pixels more than of others.
struct TileSums {
    Tile tile;
    std::vector<PixelSum> beauty;
    std::vector<CatcherSum> catchers;  ///< empty: there are no catchers
    LayerSums layers;
    std::vector<int> samples;  ///< of each pixel, so far
};

/// State that one thread keeps from tile to tile.
struct ThreadState {
    Workspace work;
    TilePattern pattern;
    std::vector<int32_t> xs, ys;       ///< of the pixels that are sampled
    std::vector<PixelSum> beauty;      ///< of the same
    std::vector<CatcherSum> catchers;  ///< likewise
    TileSums sums;                     ///< of a tile that is finished at once
    WavefrontCounters counters;
    std::unique_ptr<RayRecorder> recorder;  ///< null: no recording
};

/// What is done in every tile.
struct TileWork {
    const WavefrontInput& wavefront;
    const LayerPlan& layers;
    const std::atomic<bool>& stop;  ///< when it becomes true, tiles end after their current batch
};

/// The pattern of a tile.
///
/// In/Out  latest: of the latest call; made anew where that was for another size
const TilePattern& pattern_of(const Tile& tile, TilePattern& latest);

/// Clears the sums for a tile.
void begin_tile(const TileWork& work, const Tile& tile, TileSums& sums);

/// Takes samples of some pixels of a tile: of each the same range, which follows those it has.
///
/// In      pixels: by their numbers in the pattern, ascending
void sample_pixels(const TileWork& work,
                   std::span<const uint32_t> pixels,
                   const SampleRange& range,
                   ThreadState& state,
                   TileSums& sums);

/// Sums of blocks of samples, so that those of some blocks can be added to those before them:
/// puts the block that has just ended, and begins the next one; takes it into new sums; adds the
/// sums of the samples that follow, of one block at most, which begins where the others end. Counts
/// and nearest hits do not depend on the order of samples, and stay when a block is put.
void end_block(TileSums& sums, StateWriter& out);
void take_block(StateReader& in, TileSums& sums);
void append(const TileSums& later, TileSums& sums);

/// All of a tile's sums but the numbers of samples, to go on from; `take_sums` into new sums.
void put_sums(const TileSums& sums, StateWriter& out);
void take_sums(StateReader& in, TileSums& sums);

/// Computes an AOV in one tile and writes it into the film.
void render_aov_tile(const TileWork& work, const Tile& tile, ThreadState& state, Film& film);

/// Write the means of a tile's samples into the film: the beauty; the layers beside it.
///
/// In/Out  latest: of pattern_of
void store_beauty(const TileSums& sums, TilePattern& latest, Film& film);
void store_layers(const LayerPlan& plan, const TileSums& sums, TilePattern& latest, Film& film);

}  // namespace obscura
