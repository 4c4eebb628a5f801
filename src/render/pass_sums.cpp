// render/pass_sums.cpp - a film's sums between passes: what every pixel has had of its samples.
// SPDX-License-Identifier: Apache-2.0
#include "render/pass_sums.h"

#include "base/parallel.h"
#include "render/counts.h"

#include <algorithm>
#include <array>

namespace obscura {

namespace {

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

/// Mostly one of the two parts of a sum is zero in all pixels.
void put_beauty(const std::vector<PixelSum>& sums, StateWriter& out) {
    std::vector<std::array<double, 4>> blocks(sums.size());
    std::vector<std::array<float, 4>> latest(sums.size());
    for (size_t i = 0; i < sums.size(); ++i) {
        std::copy_n(sums[i].blocks, 4, blocks[i].begin());
        std::copy_n(sums[i].block, 4, latest[i].begin());
    }
    out.put_unless_zero(blocks);
    out.put_unless_zero(latest);
}

void take_beauty(StateReader& in, std::vector<PixelSum>& sums) {
    std::vector<std::array<double, 4>> blocks(sums.size());
    std::vector<std::array<float, 4>> latest(sums.size());
    in.take_unless_zero(blocks);
    in.take_unless_zero(latest);
    for (size_t i = 0; i < sums.size(); ++i) {
        std::copy_n(blocks[i].begin(), 4, sums[i].blocks);
        std::copy_n(latest[i].begin(), 4, sums[i].block);
    }
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

PassSums::PassSums(const std::vector<Tile>& tiles, int target) : target_(target) {
    for (const Tile& tile : tiles) {
        tiles_.emplace_back().tile = tile;
        pixels_ += pixels_in(tile);
    }
}

double PassSums::mean_samples() const {
    return static_cast<double>(samples_) / static_cast<double>(std::max<int64_t>(pixels_, 1));
}

double PassSums::fraction() const {
    return mean_samples() / target_;
}

int PassSums::min_samples() const {
    int out = target_;
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
    const std::atomic<bool> never = false;  // a tile's sums are those of whole passes
    const TileWork unbroken{work.tile_work.wavefront, work.tile_work.layers, never};
    const std::vector<int> ends = pass_ends(target_);
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
    const std::lock_guard lock(tile.using_it);
    if (tile.samples >= end) return;
    ThreadState& state = thread_state(work);
    if (tile.samples == 0) begin_tile(unbroken, tile.tile, tile.sums);
    RenderCounters before;
    add_counts(state.counters, before);
    const SampleRange range{static_cast<uint32_t>(tile.samples), end - tile.samples};
    sample_pixels(unbroken, pattern_of(tile.tile, state.pattern).all, range, state, tile.sums);
    tile.samples = end;
    samples_ += range.count * pixels_in(tile.tile);
    add_counts(counted_since(before, state.counters), tile.counters);
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
    put_beauty(tile.sums.beauty, out);
    out.put_array(tile.sums.catchers);
    tile.sums.layers.put(out);
}

void PassSums::put(StateWriter& out) const {
    out.put_number(tiles_.size());
    // On all threads, as someone may wait for the program to end.
    constexpr size_t at_once = 256;
    for (size_t first = 0; first < tiles_.size(); first += at_once) {
        std::vector<StateWriter> pieces(std::min(at_once, tiles_.size() - first));
        parallel_for(pieces.size(), [&](size_t i) { put_tile(tiles_[first + i], pieces[i]); });
        for (const StateWriter& piece : pieces)
            out.put(piece.kept().data(), piece.kept().size());
    }
}

bool PassSums::take(const TileWork& work, StateReader& in) {
    if (in.number() != tiles_.size()) return false;
    for (PassTile& tile : tiles_) {
        Tile area;
        in.take(&area, sizeof(area));
        const int samples = in.integer();
        if (!(area == tile.tile) || samples < 0 || samples > target_) return false;
        if (samples == 0) continue;
        std::array<uint64_t, 6> counted = {};
        in.take(counted.data(), sizeof(counted));
        tile.counters = counters_from_file(counted);
        begin_tile(work, tile.tile, tile.sums);
        take_beauty(in, tile.sums.beauty);
        in.take_array(tile.sums.catchers);
        tile.sums.layers.take(in);
        std::fill(tile.sums.samples.begin(), tile.sums.samples.end(), samples);
        tile.samples = samples;
        samples_ += samples * pixels_in(tile.tile);
    }
    return in.good();
}

}  // namespace obscura
