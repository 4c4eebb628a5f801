// render/pass_sums.cpp - a film's sums between passes: what every pixel has had of its samples.
// SPDX-License-Identifier: Apache-2.0
#include "render/pass_sums.h"

#include "base/parallel.h"
#include "render/counts.h"

#include <algorithm>
#include <array>

namespace obscura {

namespace {

constexpr int sum_block_size = sum_block_samples;

int64_t pixels_in(const Tile& tile) {
    return int64_t{tile.width} * tile.height;
}

/// Begins the pixels of a tile with black.
void clear_tile(const Tile& tile, Film& film) {
    const auto clear = [&](UnsetArray<float>& pixels, size_t channels) {
        for (int y = tile.y; y < tile.y + tile.height; ++y) {
            std::fill_n(pixels.data() + pixel_index(film, tile.x, y) * channels,
                        static_cast<size_t>(tile.width) * channels,
                        0.0f);
        }
    };
    clear(film.pixels, film.channels.size());
    for (FilmLayer& layer : film.layers)
        clear(layer.pixels, layer.layer.channels.size());
}

}  // namespace

std::vector<int> pass_ends(int samples_per_pixel) {
    constexpr int step = 16;
    std::vector<int> out;
    for (int end = 1; end < samples_per_pixel;) {
        out.push_back(end);
        const int more = end < step ? 3 * end : std::max(end / (step * step) * step, step);
        if (more > samples_per_pixel - end) break;
        end += more;
    }
    out.push_back(samples_per_pixel);
    return out;
}

PassSums::PassSums(const std::vector<Tile>& tiles, const SampleRange& samples, bool keeps_blocks)
    : share_(samples), keeps_blocks_(keeps_blocks) {
    for (const Tile& tile : tiles) {
        tiles_.emplace_back().tile = tile;
        pixels_ += pixels_in(tile);
    }
}

double PassSums::mean_samples() const {
    return static_cast<double>(samples_) / static_cast<double>(std::max<int64_t>(pixels_, 1));
}

double PassSums::fraction() const {
    return share_.count == 0 ? 1 : mean_samples() / share_.count;
}

int PassSums::min_samples() const {
    int out = share_.count;
    for (const PassTile& tile : tiles_) {
        const std::lock_guard lock(tile.using_it);
        out = std::min(out, tile.samples);
    }
    return out;
}

RenderCounters PassSums::counters() const {
    RenderCounters out;
    for (const PassTile& tile : tiles_) {
        const std::lock_guard lock(tile.using_it);
        add_counts(tile.counters, out);
    }
    return out;
}

void PassSums::sample(const FilmWork& work) {
    const std::atomic<bool>& stop = work.tile_work.stop;
    const std::atomic<bool> never = false;  // a tile's sums are those of all its pixels
    const TileWork unbroken{work.tile_work.wavefront, work.tile_work.layers, never};
    const std::vector<int> ends = pass_ends(share_.count);
    // Threads take tile after tile of pass after pass, and need not wait for each other between
    // passes. Who comes to a tile first does for it all that is due.
    std::atomic<size_t> next = 0;
    parallel_for(ends.size() * tiles_.size(), [&](size_t /*turn*/) {
        if (stop.load(std::memory_order_relaxed)) return;
        const size_t turn = next++;
        PassTile& tile = tiles_[turn % tiles_.size()];
        sample_tile(work, unbroken, ends[turn / tiles_.size()], tile);
        if (!work.progress || stop.load(std::memory_order_relaxed)) return;
        const Tile& area = tile.tile;
        work.progress({fraction(), {area.x, area.y, area.width, area.height}, &work.film});
    });
}

void PassSums::sample_tile(const FilmWork& work,
                           const TileWork& unbroken,
                           int end,
                           PassTile& tile) {
    const auto is_due = [&] {
        return tile.samples < end && !work.tile_work.stop.load(std::memory_order_relaxed);
    };
    while (true) {
        const std::lock_guard lock(tile.using_it);
        if (!is_due()) return;
        take_samples(work, unbroken, next_samples(tile, end), tile);
    }
}

void PassSums::take_samples(const FilmWork& work,
                            const TileWork& unbroken,
                            const SampleRange& next,
                            PassTile& tile) {
    ThreadState& state = thread_state(work);
    if (tile.samples == 0) begin_tile(unbroken, tile.tile, tile.sums);
    RenderCounters before;
    add_counts(state.counters, before);
    sample_pixels(unbroken, pattern_of(tile.tile, state.pattern).all, next, state, tile.sums);
    tile.samples += next.count;
    samples_ += next.count * pixels_in(tile.tile);
    add_counts(counted_since(before, state.counters), tile.counters);
    if (!keeps_blocks_ || tile.samples % sum_block_size != 0) return;
    StateWriter block;
    end_block(tile.sums, block);
    tile.blocks.insert(tile.blocks.end(), block.kept().begin(), block.kept().end());
}

/// Those that a tile takes next, at most up to `end`: to the end of a block, or of a few, so that
/// nobody waits long for the tile.
SampleRange PassSums::next_samples(const PassTile& tile, int end) const {
    const int most = keeps_blocks_ ? sum_block_size : 4 * sum_block_size;
    const int left = std::min(end - tile.samples, most - tile.samples % sum_block_size);
    return {share_.first + static_cast<uint32_t>(tile.samples), left};
}

void PassSums::store_tile(const LayerPlan& plan,
                          const PassTile& tile,
                          TilePattern& pattern,
                          Film& film) {
    const std::lock_guard lock(tile.using_it);
    clear_tile(tile.tile, film);
    if (tile.samples == 0) return;
    store_beauty(tile.sums, pattern, film);
    store_layers(plan, tile.sums, pattern, film);
}

void PassSums::store(const LayerPlan& plan, Film& film) const {
    parallel_for(tiles_.size(), [&](size_t i) {
        TilePattern pattern;
        store_tile(plan, tiles_[i], pattern, film);
    });
}

Film PassSums::film(const LayerPlan& plan, const Film& like) const {
    Film out = copy_areas(like, {});
    TilePattern pattern;
    for (const PassTile& tile : tiles_)
        store_tile(plan, tile, pattern, out);
    return out;
}

void PassSums::put_tile(const PassTile& tile, StateWriter& out) {
    const std::lock_guard lock(tile.using_it);
    const std::array<uint64_t, 6> counted = counters_in_file(tile.counters);
    out.put(&tile.tile, sizeof(tile.tile));
    out.put_number(static_cast<uint64_t>(tile.samples));
    if (tile.samples == 0) return;
    out.put(counted.data(), sizeof(counted));
    put_sums(tile.sums, out);
    out.put_array(tile.blocks);
}

void PassSums::put(StateWriter& out) const {
    out.put_number(tiles_.size());
    // On all threads, as someone may wait for the program to end.
    constexpr size_t at_once = 64;
    for (size_t first = 0; first < tiles_.size(); first += at_once) {
        std::vector<StateWriter> pieces(std::min(at_once, tiles_.size() - first));
        parallel_for(pieces.size(), [&](size_t i) { put_tile(tiles_[first + i], pieces[i]); });
        for (const StateWriter& piece : pieces)
            out.put(piece.kept().data(), piece.kept().size());
    }
}

/// Reads what put_tile put. The samples may be too many, and are negative where it cannot be read.
void PassSums::take_tile(const TileWork& work, StateReader& in, PassTile& tile) {
    in.take(&tile.tile, sizeof(tile.tile));
    tile.samples = in.integer();
    const Tile& area = tile.tile;
    const bool has_size = area.width > 0 && area.width <= pass_tile_side && area.height > 0 &&
                          area.height <= pass_tile_side;
    if (!in.good() || !has_size) tile.samples = -1;
    if (tile.samples <= 0) return;
    std::array<uint64_t, 6> counted = {};
    in.take(counted.data(), sizeof(counted));
    tile.counters = counters_from_file(counted);
    begin_tile(work, tile.tile, tile.sums);
    take_sums(in, tile.sums);
    in.take_new_array(tile.blocks);
    std::fill(tile.sums.samples.begin(), tile.sums.samples.end(), tile.samples);
}

bool PassSums::take(const TileWork& work, StateReader& in) {
    if (in.number() != tiles_.size()) return false;
    for (PassTile& tile : tiles_) {
        const Tile wanted = tile.tile;
        take_tile(work, in, tile);
        if (!(tile.tile == wanted) || tile.samples < 0 || tile.samples > share_.count) return false;
        samples_ += tile.samples * pixels_in(tile.tile);
    }
    return in.good();
}

/// Adds the blocks of a later share of a tile's samples, then the one in progress.
bool PassSums::append_tile(const TileWork& work, const PassTile& later, TileSums& sums) {
    StateReader in(later.blocks);
    TileSums block;
    while (in.good() && !in.at_end()) {
        begin_tile(work, later.tile, block);
        take_block(in, block);
        obscura::append(block, sums);
    }
    obscura::append(later.sums, sums);
    return in.good();
}

bool PassSums::append(const TileWork& work, const SampleRange& samples, StateReader& in) {
    if (in.number() != tiles_.size()) return false;
    for (PassTile& tile : tiles_) {
        PassTile later;
        take_tile(work, in, later);
        if (!in.good() || !(later.tile == tile.tile) || later.samples != samples.count)
            return false;
        if (static_cast<uint32_t>(tile.samples) != samples.first) return false;
        if (later.samples == 0) continue;
        if (tile.samples == 0) begin_tile(work, tile.tile, tile.sums);
        if (!append_tile(work, later, tile.sums)) return false;
        tile.samples += later.samples;
        samples_ += later.samples * pixels_in(tile.tile);
        add_counts(later.counters, tile.counters);
    }
    return true;
}

}  // namespace obscura
