// render/pass_sums.cpp - a film's sums in passes of all pixels, which all take as many samples.
// SPDX-License-Identifier: Apache-2.0
#include "render/pass_sums.h"

#include "base/parallel.h"
#include "render/counts.h"

#include <algorithm>

namespace obscura {

namespace {

constexpr int sum_block_size = sum_block_samples;

}  // namespace

std::vector<int> pass_ends(int samples_per_pixel, bool shows_early) {
    constexpr int step = sum_block_size;
    constexpr int usual = 4 * step;  // what next_samples takes at once
    std::vector<int> out;
    for (int end = shows_early ? 1 : usual; end < samples_per_pixel;) {
        out.push_back(end);
        const int more = end < usual ? 3 * end : std::max(end / (step * step) * step, usual);
        if (more > samples_per_pixel - end) break;
        end += more;
    }
    out.push_back(samples_per_pixel);
    return out;
}

PassSums::PassSums(const std::vector<Tile>& tiles,
                   const SampleRange& samples,
                   bool keeps_blocks,
                   bool shows_early)
    : FilmSums(tiles),
      share_(samples),
      keeps_blocks_(keeps_blocks),
      ends_(pass_ends(samples.count, shows_early)),
      blocks_(tiles.size()) {}

double PassSums::fraction() const {
    return share_.count == 0 ? 1 : mean_samples() / share_.count;
}

void PassSums::sample(const FilmWork& work) {
    const std::atomic<bool>& stop = work.tile_work.stop;
    const size_t count = tiles().size();
    // Threads take tile after tile of pass after pass, and need not wait for each other between
    // passes. Who comes to a tile first does for it all that is due.
    std::atomic<size_t> next = 0;
    parallel_for(ends_.size() * count, [&](size_t /*turn*/) {
        if (stop.load(std::memory_order_relaxed)) return;
        const size_t turn = next++;
        sample_tile(work, ends_[turn / count], turn % count);
        if (!work.progress || stop.load(std::memory_order_relaxed)) return;
        const size_t i = turn % count;
        const Tile& area = tiles()[i].tile;
        work.progress(
            {fraction(), {area.x, area.y, area.width, area.height}, &work.film, {}, this, i});
    });
}

void PassSums::sample_tile(const FilmWork& work, int end, size_t i) {
    SumsTile& tile = tiles()[i];
    const auto is_due = [&] {
        return tile.samples < end && !work.tile_work.stop.load(std::memory_order_relaxed);
    };
    while (true) {
        const std::lock_guard lock(tile.using_it);
        if (!is_due()) return;
        const TilePattern& pattern = pattern_of(tile.tile, thread_state(work).pattern);
        take_samples(work, pattern.all, next_samples(tile, end), tile);
        if (!keeps_blocks_ || tile.samples % sum_block_size != 0) continue;
        StateWriter block;
        end_block(tile.sums, block);
        blocks_[i].insert(blocks_[i].end(), block.kept().begin(), block.kept().end());
    }
}

/// Those that a tile takes next, at most up to `end`: to the end of a block, or of a few, so that
/// nobody waits long for the tile.
SampleRange PassSums::next_samples(const SumsTile& tile, int end) const {
    const int most = keeps_blocks_ ? sum_block_size : 4 * sum_block_size;
    const int left = std::min(end - tile.samples, most - tile.samples % sum_block_size);
    return {share_.first + static_cast<uint32_t>(tile.samples), left};
}

void PassSums::put_more(size_t tile, StateWriter& out) const {
    out.put_array(blocks_[tile]);
}

bool PassSums::take_more(size_t tile, StateReader& in) {
    in.take_new_array(blocks_[tile]);
    return in.good();
}

/// Adds the blocks of a later share of a tile's samples, then the one in progress.
bool PassSums::append_tile(const TileWork& work,
                           StateReader& in,
                           const SampleRange& samples,
                           size_t i) {
    SumsTile& tile = tiles()[i];
    SumsTile later;
    take_tile(work, in, later);
    if (!in.good() || !(later.tile == tile.tile) || later.samples != samples.count) return false;
    if (static_cast<uint32_t>(tile.samples) != samples.first) return false;
    if (later.samples == 0) return true;
    if (tile.samples == 0) begin_tile(work, tile.tile, tile.sums);
    Bytes bytes;
    in.take_new_array(bytes);
    StateReader blocks(bytes);
    TileSums block;
    while (blocks.good() && !blocks.at_end()) {
        begin_tile(work, later.tile, block);
        take_block(blocks, block);
        obscura::append(block, tile.sums);
    }
    obscura::append(later.sums, tile.sums);
    tile.samples += later.samples;
    count_taken(int64_t{later.samples} * static_cast<int64_t>(later.sums.samples.size()));
    add_counts(later.counters, tile.counters);
    return in.good() && blocks.good();
}

bool PassSums::append(const TileWork& work, const SampleRange& samples, StateReader& in) {
    return take_pieces(
        in, [&](size_t i, StateReader& piece) { return append_tile(work, piece, samples, i); });
}

}  // namespace obscura
