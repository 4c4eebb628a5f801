// render/adaptive_sums.h - adaptive sampling: a film's sums, each pass for the pixels in need.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "film/noise.h"
#include "render/film_sums.h"

#include <optional>

namespace obscura {

/// The sums of a film that is rendered with RenderOptions::adaptive. The first pass takes the least
/// number of samples of every pixel, each later one those of the pixels in need, by the noise of
/// the film that the passes before it left. Pixels go on in groups of neighbours, since their rays
/// are soonest traced together. Threads wait for each other between two passes: then the film is
/// whole.
class AdaptiveSums final : public FilmSums {
public:
    /// In      film: the one that is rendered
    AdaptiveSums(const std::vector<Tile>& tiles, const RenderOptions& options, const Film& film);

    int target() const override { return max_samples_; }
    /// Of the passes that are expected; 1 only when no pixel needs more.
    double fraction() const override;
    void sample(const FilmWork& work) override;
    void put(StateWriter& out) const override;
    bool take(const TileWork& work, StateReader& in) override;

    /// What was done. To be asked when `sample` has ended.
    SamplesTaken taken() const;

private:
    /// What a file holds of a pixel beside its sums: the members below.
    struct PixelPlan {
        int samples, goal, samples_before;
        bool operator==(const PixelPlan&) const = default;
    };

    /// A pixel's place in the film, and its group.
    struct PixelPlace {
        size_t at, group;
    };

    std::vector<PixelPlace> places(const Tile& tile, TilePattern& latest) const;
    std::vector<size_t> groups_in(const Tile& tile) const;
    void run_pass(const FilmWork& work);
    void sample_tiles(const FilmWork& work);
    void sample_tile(const FilmWork& work, SumsTile& tile);
    bool take_next_samples(const FilmWork& work, SumsTile& tile);
    void note_pixels(const Film& film, const Tile& tile, TilePattern& latest);
    void store_all(const FilmWork& work) const;
    std::vector<float> costs_of_groups() const;
    std::vector<float> deviations_of(const Film& film) const;
    bool begin_next_pass(const FilmWork& work);
    void put_more(size_t tile, StateWriter& out) const override;
    bool take_more(size_t tile, StateReader& in) override;

    const AdaptiveOptions adaptive_;
    const int max_samples_;
    const std::vector<int> levels_;  ///< the numbers of samples that pixels stop at
    const Film shape_;               ///< size and channels of the film, without pixels
    /// Held while the plan of a pass is made; and while the sums are put, which are those of one
    /// pass.
    mutable std::mutex planning_;
    std::atomic<int> passes_ = 0;         ///< that have ended
    std::atomic<size_t> tiles_done_ = 0;  ///< of the pass in progress
    std::atomic<bool> is_over_ = false;   ///< no pixel needs more
    int limit_ = 0;                       ///< of samples, for the sweep in progress
    // By the number of a group of pixels. Those of a tile, which has whole groups, belong to its
    // lock; so do its pixels of the last.
    const PixelGroups groups_;
    const std::vector<int> sizes_;     ///< pixels
    std::vector<int> samples_;         ///< of each pixel
    std::vector<int> goals_;           ///< at the end of the pass in progress
    std::vector<int> samples_before_;  ///< when they were noted the last time
    std::vector<float> deviations_;    ///< after the latest pass that has ended
    std::vector<float> before_;        ///< the film's pixels then
};

}  // namespace obscura
