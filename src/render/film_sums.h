// render/film_sums.h - a film's sums while it is rendered in passes: others may look at them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "film/state_bytes.h"
#include "render/tile.h"

#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace obscura {

/// A film, and what fills it.
struct FilmWork {
    const TileWork& tile_work;
    const RenderOptions& options;
    const ProgressFunction& progress;
    std::vector<std::unique_ptr<ThreadState>>& states;
    Film& film;
};

/// The state of the calling thread, made when it is first asked for.
ThreadState& thread_state(const FilmWork& work);

/// Side of a tile, whatever RenderOptions::tile_size says: sums in a file fit every run, and a few
/// samples of a tile fill a batch.
inline constexpr int pass_tile_side = 32;

/// The sums of a film whose pixels take their samples in passes, tile by tile in each. A pixel's
/// samples are added in the order of their numbers, so that it has the bits of a rendering that
/// takes all of them at once. Other threads may look meanwhile: they see every tile as it was left
/// by the latest step of a few samples.
class FilmSums {
public:
    virtual ~FilmSums() = default;
    FilmSums(const FilmSums&) = delete;
    FilmSums& operator=(const FilmSums&) = delete;

    /// The number of samples that a pixel takes, at most.
    virtual int target() const = 0;
    /// How much of the work is done, from 0 to 1.
    virtual double fraction() const = 0;
    /// Samples of all pixels together, so far; of each in the mean; and of the pixel with fewest.
    int64_t samples() const { return samples_; }
    double mean_samples() const;
    int min_samples() const;
    /// What was counted in making them.
    RenderCounters counters() const;

    /// Takes the samples that are missing. When work.tile_work.stop becomes true, tiles end after
    /// the next few samples.
    virtual void sample(const FilmWork& work) = 0;

    /// Writes the means of all pixels into a film of which they are a part; pixels of tiles without
    /// samples become 0.
    ///
    /// In/Out  film: its layers are still arrays of zeros
    void store(const LayerPlan& plan, Film& film) const;
    /// The same into a new film, which has the size and layers of another one.
    Film film(const LayerPlan& plan, const Film& like) const;
    /// The beauty of one tile so far, as a part of that image, and the samples of its pixel with
    /// fewest.
    struct TileSoFar {
        Film film;
        int samples = 0;
    };
    TileSoFar beauty_of(size_t tile, const Film& like) const;

    /// All of it, to go on from. `take` is called before `sample`; it returns false when the tiles
    /// are others, or have more samples than the target, and then the object is of no more use.
    virtual void put(StateWriter& out) const;
    virtual bool take(const TileWork& work, StateReader& in);
    /// Adds what the sums of a later share have put: one that keeps blocks, begins where these sums
    /// end, and is complete. False: it is another one, or these sums take none.
    virtual bool append(const TileWork& work, const SampleRange& samples, StateReader& in);

protected:
    struct SumsTile {
        mutable std::mutex using_it;  ///< held while it is sampled
        Tile tile;
        int samples = 0;  ///< of the pixel with fewest; 0: `sums` are not begun
        TileSums sums;
        RenderCounters counters;
    };

    /// In      tiles: of pass_tile_side
    explicit FilmSums(const std::vector<Tile>& tiles);

    std::deque<SumsTile>& tiles() { return tiles_; }
    const std::deque<SumsTile>& tiles() const { return tiles_; }

    /// Takes samples of some pixels of a tile, which is locked; to the end, whatever stop says.
    ///
    /// In      pixels: by their numbers in the tile's pattern, ascending
    void take_samples(const FilmWork& work,
                      std::span<const uint32_t> pixels,
                      const SampleRange& range,
                      SumsTile& tile);
    /// Reads what `put` put of a tile, without put_more. The samples may be too many, and are
    /// negative where it cannot be read.
    static void take_tile(const TileWork& work, StateReader& in, SumsTile& tile);
    /// Calls `take` with the number of each tile and what `put` put of it, on all threads. False:
    /// it was so for a tile, a piece was not read to its end, or the tiles are others.
    using TakePiece = std::function<bool(size_t tile, StateReader& piece)>;
    bool take_pieces(StateReader& in, const TakePiece& take);
    void count_taken(int64_t samples) { samples_ += samples; }

private:
    /// What there is of a tile beside its sums, if it has samples.
    virtual void put_more(size_t tile, StateWriter& out) const = 0;
    virtual bool take_more(size_t tile, StateReader& in) = 0;

    void put_tile(size_t i, StateWriter& out) const;
    static void store_tile(const LayerPlan& plan,
                           const SumsTile& tile,
                           TilePattern& pattern,
                           Film& film);

    int64_t pixels_ = 0;
    std::deque<SumsTile> tiles_;
    std::atomic<int64_t> samples_ = 0;
};

/// A film that is rendered in passes. The sums outlive it; the rest is there until
/// FilmShare::leave.
struct PassFilm {
    std::shared_ptr<FilmSums> sums;
    const TileWork& work;
    const Film& film;  ///< for its size and layers: the pixels come at the end
};

}  // namespace obscura
