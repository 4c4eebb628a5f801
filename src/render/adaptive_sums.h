// render/adaptive_sums.h - adaptive sampling: a film's sums, each pass for the pixels in need.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/film_sums.h"

#include <optional>

namespace obscura {

/// The sums of a film that is rendered with RenderOptions::adaptive. The first two passes take the
/// least number of samples of every pixel, each later one those of the pixels in need, by the noise
/// of the film that the passes before it left. Threads wait for each other between two passes: then
/// the film is whole.
class AdaptiveSums final : public FilmSums {
public:
    /// In      film: the one that is rendered
    AdaptiveSums(const std::vector<Tile>& tiles, const RenderOptions& options, const Film& film);

    int target() const override { return max_samples_; }
    /// Of the passes that there may be.
    double fraction() const override;
    void sample(const FilmWork& work) override;
    void put(StateWriter& out) const override;
    bool take(const TileWork& work, StateReader& in) override;

    /// What was done. To be asked when `sample` has ended.
    ///
    /// In      film: with the beauty of these sums
    SamplesTaken taken(const Film& film) const;

private:
    /// What a file holds of a pixel beside its sums: the members below.
    struct PixelPlan {
        int samples, started, goal, samples_before;
    };

    std::vector<size_t> film_indices(const Tile& tile, TilePattern& latest) const;
    void run_pass(const FilmWork& work);
    void sample_tile(const FilmWork& work, SumsTile& tile);
    bool take_next_samples(const FilmWork& work, const std::vector<size_t>& at, SumsTile& tile);
    void note_pixel(const Film& film, size_t at);
    void store_all(const FilmWork& work) const;
    std::vector<int> samples_of_film() const;
    std::vector<float> deviations_of(const Film& film, std::span<const int> samples) const;
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
    // By the film's index of a pixel. Those of a tile belong to its lock.
    std::vector<int> started_;         ///< samples when the pass in progress began
    std::vector<int> goals_;           ///< samples at its end
    std::vector<int> samples_before_;  ///< before the pixel's latest pass; 0 in its first
    std::vector<float> before_;        ///< the pixel then
};

}  // namespace obscura
