// render/film_sums.cpp - a film's sums while it is rendered in passes: others may look at them.
// SPDX-License-Identifier: Apache-2.0
#include "render/film_sums.h"

#include "base/parallel.h"
#include "render/counts.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace obscura {

namespace {

int64_t pixels_in(const Tile& tile) {
    return int64_t{tile.width} * tile.height;
}

void clear_beauty(const Tile& tile, Film& film) {
    const size_t channels = film.channels.size();
    for (int y = tile.y; y < tile.y + tile.height; ++y) {
        std::fill_n(film.pixels.data() + pixel_index(film, tile.x, y) * channels,
                    static_cast<size_t>(tile.width) * channels,
                    0.0f);
    }
}

int fewest(const TileSums& sums) {
    return *std::min_element(sums.samples.begin(), sums.samples.end());
}

}  // namespace

ThreadState& thread_state(const FilmWork& work) {
    std::unique_ptr<ThreadState>& state = work.states[thread_index()];
    if (state) return *state;
    state = std::make_unique<ThreadState>();
    if (work.options.recording != nullptr) {
        const RayReach reach = work.tile_work.wavefront.accel->ray_reach();
        state->recorder = std::make_unique<RayRecorder>(reach);
    }
    return *state;
}

FilmSums::FilmSums(const std::vector<Tile>& tiles) {
    for (const Tile& tile : tiles) {
        tiles_.emplace_back().tile = tile;
        pixels_ += pixels_in(tile);
    }
}

double FilmSums::mean_samples() const {
    return static_cast<double>(samples_) / static_cast<double>(std::max<int64_t>(pixels_, 1));
}

int FilmSums::min_samples() const {
    int out = target();
    for (const SumsTile& tile : tiles_) {
        const std::lock_guard lock(tile.using_it);
        out = std::min(out, tile.samples);
    }
    return out;
}

RenderCounters FilmSums::counters() const {
    RenderCounters out;
    for (const SumsTile& tile : tiles_) {
        const std::lock_guard lock(tile.using_it);
        add_counts(tile.counters, out);
    }
    return out;
}

void FilmSums::take_samples(const FilmWork& work,
                            std::span<const uint32_t> pixels,
                            const SampleRange& range,
                            SumsTile& tile) {
    const std::atomic<bool> never = false;  // a tile's sums are those of all its pixels
    const TileWork unbroken{work.tile_work.wavefront, work.tile_work.layers, never};
    ThreadState& state = thread_state(work);
    if (tile.samples == 0) begin_tile(unbroken, tile.tile, tile.sums);
    RenderCounters before;
    add_counts(state.counters, before);
    sample_pixels(unbroken, pixels, range, state, tile.sums);
    tile.samples = fewest(tile.sums);
    count_taken(int64_t{range.count} * static_cast<int64_t>(pixels.size()));
    add_counts(counted_since(before, state.counters), tile.counters);
}

void FilmSums::store_tile(const LayerPlan& plan,
                          const SumsTile& tile,
                          TilePattern& pattern,
                          Film& film) {
    const std::lock_guard lock(tile.using_it);
    if (tile.samples == 0) return clear_beauty(tile.tile, film);
    store_beauty(tile.sums, pattern, film);
    store_layers(plan, tile.sums, pattern, film);
}

void FilmSums::store(const LayerPlan& plan, Film& film) const {
    parallel_for(tiles_.size(), [&](size_t i) {
        TilePattern pattern;
        store_tile(plan, tiles_[i], pattern, film);
    });
}

Film FilmSums::film(const LayerPlan& plan, const Film& like) const {
    Film out = copy_areas(like, {});
    TilePattern pattern;
    for (const SumsTile& tile : tiles_)
        store_tile(plan, tile, pattern, out);
    return out;
}

FilmSums::TileSoFar FilmSums::beauty_of(size_t i, const Film& like) const {
    const SumsTile& tile = tiles_[i];
    const Tile& area = tile.tile;
    const ImagePart whole = like.part_of.value_or(ImagePart{like.width, like.height, 0, 0});
    Film out;
    out.width = area.width;
    out.height = area.height;
    out.channels = like.channels;
    out.part_of = ImagePart{whole.width, whole.height, area.x, area.y};
    out.pixels = zero_array<float>(static_cast<size_t>(area.width) *
                                   static_cast<size_t>(area.height) * like.channels.size());
    TilePattern pattern;
    const std::lock_guard lock(tile.using_it);
    if (tile.samples > 0) store_beauty(tile.sums, pattern, out);
    return {std::move(out), tile.samples};
}

void FilmSums::put_tile(size_t i, StateWriter& out) const {
    const SumsTile& tile = tiles_[i];
    const std::lock_guard lock(tile.using_it);
    const std::array<uint64_t, 6> counted = counters_in_file(tile.counters);
    out.put(&tile.tile, sizeof(tile.tile));
    out.put_number(static_cast<uint64_t>(tile.samples));
    if (tile.samples == 0) return;
    out.put(counted.data(), sizeof(counted));
    put_sums(tile.sums, out);
    put_more(i, out);
}

void FilmSums::put(StateWriter& out) const {
    out.put_number(tiles_.size());
    // On all threads, as someone may wait for the program to end.
    constexpr size_t at_once = 64;
    for (size_t first = 0; first < tiles_.size(); first += at_once) {
        std::vector<StateWriter> pieces(std::min(at_once, tiles_.size() - first));
        parallel_for(pieces.size(), [&](size_t i) { put_tile(first + i, pieces[i]); });
        for (const StateWriter& piece : pieces)
            out.put_array(piece.kept());
    }
}

void FilmSums::take_tile(const TileWork& work, StateReader& in, SumsTile& tile) {
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
    std::fill(tile.sums.samples.begin(), tile.sums.samples.end(), tile.samples);
}

bool FilmSums::take_pieces(StateReader& in, const TakePiece& take) {
    if (in.number() != tiles_.size()) return false;
    std::vector<StateReader> pieces;
    for (size_t i = 0; i < tiles_.size(); ++i)
        pieces.push_back(in.piece());
    std::atomic<bool> all_fit = in.good();
    parallel_for(pieces.size(), [&](size_t i) {
        if (!all_fit.load(std::memory_order_relaxed)) return;
        if (!take(i, pieces[i]) || !pieces[i].good() || !pieces[i].at_end()) all_fit = false;
    });
    return all_fit;
}

bool FilmSums::take(const TileWork& work, StateReader& in) {
    return take_pieces(in, [&](size_t i, StateReader& piece) {
        SumsTile& tile = tiles_[i];
        const Tile wanted = tile.tile;
        take_tile(work, piece, tile);
        if (!(tile.tile == wanted) || tile.samples < 0 || tile.samples > target()) return false;
        if (tile.samples == 0) return true;
        if (!take_more(i, piece)) return false;
        const std::vector<int>& samples = tile.sums.samples;
        count_taken(std::accumulate(samples.begin(), samples.end(), int64_t{0}));
        return true;
    });
}

bool FilmSums::append(const TileWork& /*work*/,
                      const SampleRange& /*samples*/,
                      StateReader& /*in*/) {
    return false;
}

}  // namespace obscura
