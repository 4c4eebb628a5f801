// render/pass_sums.h - a film's sums between passes: what every pixel has had of its samples.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "film/state_bytes.h"
#include "render/passes.h"

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

namespace obscura {

/// The numbers of samples that pixels have after each pass, ascending: 1, 4, 16, then 16 more each
/// time, from 256 on a sixteenth more, in steps of 16; at last all of them. The first pass is
/// short, so that all of the film is there soon; later ones fill batches.
std::vector<int> pass_ends(int samples_per_pixel);

/// Side of a tile, whatever RenderOptions::tile_size says: sums in a file fit every run, and four
/// samples of a tile fill a batch.
inline constexpr int pass_tile_side = 32;

/// The sums of a film whose pixels take their samples in passes, tile by tile in each. A pixel's
/// samples are added in the order of their numbers, so that it has the bits of a rendering that
/// takes all of them at once. Other threads may look meanwhile: they see every tile as a pass left
/// it.
class PassSums {
public:
    /// In      tiles: of pass_tile_side
    ///         samples: those of every pixel that are to be taken
    ///         keeps_blocks: the sums of each block of samples are kept apart, for `append`;
    ///         `store` and `film` cannot be used
    PassSums(const std::vector<Tile>& tiles, const SampleRange& samples, bool keeps_blocks);

    /// The number of samples that are to be taken.
    int target() const { return share_.count; }
    /// Samples of all pixels together, so far.
    int64_t samples() const { return samples_; }
    /// The same for each pixel in the mean, and as a fraction of all; and of the pixel with fewest.
    double mean_samples() const;
    double fraction() const;
    int min_samples() const;
    /// What was counted in making them.
    RenderCounters counters() const;

    /// Takes the samples that are missing. When work.tile_work.stop becomes true, tiles end after
    /// the next few samples.
    void sample(const FilmWork& work);

    /// Writes the means of all pixels into a film of which they are a part; pixels of tiles without
    /// samples become 0.
    void store(const LayerPlan& plan, Film& film) const;
    /// The same into a new film, which has the size and layers of another one.
    Film film(const LayerPlan& plan, const Film& like) const;

    /// All of it, to go on from. `take` is called before `sample`; it returns false when the tiles
    /// are others, or have more samples than the target, and then the object is of no more use.
    void put(StateWriter& out) const;
    bool take(const TileWork& work, StateReader& in);
    /// Adds what the sums of a later share have put: one that keeps blocks, begins where these sums
    /// end, and is complete. False: it is another one.
    bool append(const TileWork& work, const SampleRange& samples, StateReader& in);

private:
    struct PassTile {
        mutable std::mutex using_it;  ///< held while it is sampled
        Tile tile;
        int samples = 0;  ///< of each pixel; 0: `sums` are not begun
        TileSums sums;    ///< with keeps_blocks_: of the block in progress
        Bytes blocks;     ///< with keeps_blocks_: the sums of finished ones, of end_block
        RenderCounters counters;
    };

    void sample_tile(const FilmWork& work, const TileWork& unbroken, int end, PassTile& tile);
    SampleRange next_samples(const PassTile& tile, int end) const;
    void take_samples(const FilmWork& work,
                      const TileWork& unbroken,
                      const SampleRange& next,
                      PassTile& tile);
    static void put_tile(const PassTile& tile, StateWriter& out);
    static void take_tile(const TileWork& work, StateReader& in, PassTile& tile);
    static bool append_tile(const TileWork& work, const PassTile& later, TileSums& sums);
    static void store_tile(const LayerPlan& plan,
                           const PassTile& tile,
                           TilePattern& pattern,
                           Film& film);

    const SampleRange share_;
    const bool keeps_blocks_;
    int64_t pixels_ = 0;
    std::deque<PassTile> tiles_;
    std::atomic<int64_t> samples_ = 0;
};

/// A film that is rendered in passes. The sums outlive it; the rest is there until
/// FilmShare::leave.
struct PassFilm {
    std::shared_ptr<PassSums> sums;
    const TileWork& work;
    const Film& film;  ///< for its size and layers: the pixels come at the end
};

}  // namespace obscura
