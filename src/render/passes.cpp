// render/passes.cpp - adaptive sampling: passes over the whole film, each of the pixels in need.
// SPDX-License-Identifier: Apache-2.0
#include "render/passes.h"

#include "base/parallel.h"
#include "film/noise.h"
#include "render/sample_plan.h"

#include <algorithm>

namespace obscura {

namespace {

/// Side of a tile, at least: in late passes few pixels of a tile are left, and small batches are
/// slow.
constexpr int min_tile_side = 32;

/// What is kept of the film's pixels between passes, by their index in it.
struct PassState {
    std::vector<float> before;        ///< the pixels before each one's latest samples
    std::vector<int> samples_before;  ///< likewise, the number of samples
    std::vector<int> samples;
    std::vector<uint8_t> wanted;  ///< 1: takes samples in the next pass
};

PassState begin_passes(const Film& film) {
    const size_t pixels = film.pixels.size() / film.channels.size();
    PassState out;
    out.before.assign(film.pixels.size(), 0.0f);
    out.samples_before.assign(pixels, 0);
    out.samples.assign(pixels, 0);
    out.wanted.assign(pixels, 1);
    return out;
}

/// The film's index of each pixel of a tile.
std::vector<size_t> film_indices(const Tile& tile, ThreadState& state, const Film& film) {
    const TilePattern& pattern = pattern_of(tile, state.pattern);
    std::vector<size_t> at;
    for (size_t i = 0; i < pattern.all.size(); ++i)
        at.push_back(pixel_index(film, tile.x + pattern.dx[i], tile.y + pattern.dy[i]));
    return at;
}

/// Takes the next samples of the tile's pixels that are wanted. Those with equally many go
/// together.
void sample_tile(const FilmWork& work,
                 const std::vector<int>& levels,
                 PassState& passes,
                 ThreadState& state,
                 TileSums& sums) {
    const std::vector<size_t> at = film_indices(sums.tile, state, work.film);
    const auto is_wanted = [&](size_t index) { return passes.wanted[index] != 0; };
    if (std::none_of(at.begin(), at.end(), is_wanted)) return;
    const size_t channels = work.film.channels.size();
    std::vector<uint32_t> pixels;
    int first = 0;
    for (const int last : levels) {
        pixels.clear();
        for (uint32_t i = 0; i < at.size(); ++i) {
            if (!is_wanted(at[i]) || passes.samples[at[i]] != first) continue;
            pixels.push_back(i);
            passes.samples_before[at[i]] = first;
            std::copy_n(work.film.pixels.data() + at[i] * channels,
                        first > 0 ? channels : 0,
                        passes.before.data() + at[i] * channels);
        }
        const SampleRange range{static_cast<uint32_t>(first), last - first};
        sample_pixels(work.tile_work, pixels, range, state, sums);
        first = last;
    }
    if (work.tile_work.stop.load(std::memory_order_relaxed)) return;
    store_beauty(sums, state.pattern, work.film);
    for (size_t i = 0; i < at.size(); ++i)
        passes.samples[at[i]] = sums.samples[i];
}

/// The noise of the film as it is.
std::vector<float> deviations_of(const FilmWork& work, const PassState& passes) {
    const Film& film = work.film;
    return sample_deviations({.width = film.width,
                              .height = film.height,
                              .channels = film.channels.size(),
                              .pixels = std::span(film.pixels.data(), film.pixels.size()),
                              .before = passes.before,
                              .samples = passes.samples,
                              .samples_before = passes.samples_before,
                              .white = work.options.adaptive->white});
}

/// Chooses the pixels of the next pass, and tells the noise that is left. The first two passes, to
/// the least number of samples, take all. Returns false when no pixel is left.
bool choose_pixels(const FilmWork& work, PassState& passes, SamplesTaken& taken) {
    constexpr int passes_of_all = 2;
    if (taken.passes < passes_of_all) return true;
    const AdaptiveOptions& adaptive = *work.options.adaptive;
    const std::vector<float> deviations = deviations_of(work, passes);
    taken.noise = image_noise(deviations, passes.samples);
    passes.wanted = pixels_in_need(
        deviations, passes.samples, {adaptive.noise_target, work.options.samples_per_pixel});
    return std::find(passes.wanted.begin(), passes.wanted.end(), 1) != passes.wanted.end();
}

void count_samples(const PassState& passes, SamplesTaken& out) {
    const auto [least, most] = std::minmax_element(passes.samples.begin(), passes.samples.end());
    out.least = *least;
    out.most = *most;
    out.pixels = passes.samples.size();
    for (const int samples : passes.samples)
        out.total += static_cast<uint64_t>(samples);
}

/// The tiles of a film with what is kept of each.
struct PassTiles {
    std::vector<Tile> tiles;
    std::vector<TileSums> sums;
    std::vector<int> levels;
};

/// Samples the pixels that are wanted.
void run_pass(const FilmWork& work, int number, PassTiles& film, PassState& passes) {
    const std::atomic<bool>& stop = work.tile_work.stop;
    std::atomic<size_t> finished = 0;
    parallel_for(film.tiles.size(), [&](size_t i) {
        if (stop.load(std::memory_order_relaxed)) return;
        const Tile& tile = film.tiles[i];
        if (number == 0) begin_tile(work.tile_work, tile, film.sums[i]);
        sample_tile(work, film.levels, passes, thread_state(work), film.sums[i]);
        const double part =
            static_cast<double>(++finished) / static_cast<double>(film.tiles.size());
        if (!work.progress || stop.load(std::memory_order_relaxed)) return;
        const double done = (number + part) / static_cast<double>(film.levels.size());
        work.progress({std::min(done, 1.0), {tile.x, tile.y, tile.width, tile.height}, &work.film});
    });
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

SamplesTaken render_passes(const FilmWork& work) {
    const RenderOptions& options = work.options;
    const PixelRect whole{0, 0, options.width, options.height};
    PassTiles film;
    film.tiles =
        cut_tiles(options.crop.value_or(whole), std::max(options.tile_size, min_tile_side));
    film.sums.resize(film.tiles.size());
    film.levels = sample_levels(options.adaptive->min_samples, options.samples_per_pixel);
    PassState passes = begin_passes(work.film);
    SamplesTaken taken;
    do {
        run_pass(work, taken.passes++, film, passes);
        if (work.tile_work.stop) return taken;
    } while (choose_pixels(work, passes, taken));
    parallel_for(film.tiles.size(), [&](size_t i) {
        store_layers(work.tile_work.layers, film.sums[i], thread_state(work).pattern, work.film);
    });
    count_samples(passes, taken);
    // Only now it is known that no pass follows.
    const Tile& first = film.tiles.front();
    if (work.progress)
        work.progress({1.0, {first.x, first.y, first.width, first.height}, &work.film});
    return taken;
}

}  // namespace obscura
