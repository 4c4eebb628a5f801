// render/pass_sums.h - a film's sums in passes of all pixels, which all take as many samples.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/film_sums.h"

namespace obscura {

/// The numbers of samples that pixels have after each pass, ascending: 64, then 64 more each time,
/// from 1280 on a sixteenth more, in steps of 16; at last all of them.
///
/// In      shows_early: the first ones are 1, 4, 16 and 64, so that all of the film is there soon
std::vector<int> pass_ends(int samples_per_pixel, bool shows_early);

/// The sums of a film all of whose pixels take the same samples.
class PassSums final : public FilmSums {
public:
    /// In      samples: those of every pixel that are to be taken
    ///         keeps_blocks: the sums of each block of samples are kept apart, for `append`;
    ///         `store` and `film` cannot be used
    ///         shows_early: as of pass_ends
    PassSums(const std::vector<Tile>& tiles,
             const SampleRange& samples,
             bool keeps_blocks,
             bool shows_early);

    int target() const override { return share_.count; }
    /// Of the samples.
    double fraction() const override;
    void sample(const FilmWork& work) override;
    bool append(const TileWork& work, const SampleRange& samples, StateReader& in) override;

private:
    void sample_tile(const FilmWork& work, int end, size_t i);
    SampleRange next_samples(const SumsTile& tile, int end) const;
    bool append_tile(const TileWork& work, StateReader& in, const SampleRange& samples, size_t i);
    void put_more(size_t tile, StateWriter& out) const override;
    bool take_more(size_t tile, StateReader& in) override;

    const SampleRange share_;
    const bool keeps_blocks_;
    const std::vector<int> ends_;  ///< of its passes
    /// With keeps_blocks_: of each tile the finished blocks, of end_block; the tile's sums are
    /// those of the block in progress.
    std::vector<Bytes> blocks_;
};

}  // namespace obscura
