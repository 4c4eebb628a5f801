// render/tile.cpp - a tile of the film: its pixels, the sums over their samples, and how they grow.
// SPDX-License-Identifier: Apache-2.0
#include "render/tile.h"

#include "base/stopwatch.h"
#include "render/film_rows.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace obscura {

namespace {

/// Whether tile a comes before b along the Z-shaped curve over the film: tiles that follow one
/// another lie together, and rays find in the caches what their neighbours left there.
/// Source  Chan, "Closest-Point Problems Simplified on the RAM", SODA 2002
bool is_before(const PixelRect& area, int size, const Tile& a, const Tile& b) {
    const auto place = [&](const Tile& tile) {
        return std::pair((tile.x - area.x) / size, (tile.y - area.y) / size);
    };
    const auto [ax, ay] = place(a);
    const auto [bx, by] = place(b);
    const int x = ax ^ bx, y = ay ^ by;
    const bool is_top_bit_of_x_higher = y < x && y < (x ^ y);
    return is_top_bit_of_x_higher ? ax < bx : ay < by;
}

void fill_pattern(int width, int height, TilePattern& pattern) {
    pattern = {width, height, {}, {}, {}};
    for (int block_y = 0; block_y < height; block_y += 4) {
        for (int block_x = 0; block_x < width; block_x += 4) {
            for (int y = block_y; y < std::min(block_y + 4, height); ++y) {
                for (int x = block_x; x < std::min(block_x + 4, width); ++x) {
                    pattern.dx.push_back(x);
                    pattern.dy.push_back(y);
                }
            }
        }
    }
    pattern.all.resize(pattern.dx.size());
    std::iota(pattern.all.begin(), pattern.all.end(), 0U);
}

/// Lists the places of some pixels, padded by 16 because stages read whole registers.
void list_pixels(const Tile& tile, std::span<const uint32_t> pixels, ThreadState& state) {
    const TilePattern& pattern = pattern_of(tile, state.pattern);
    state.xs.resize(pixels.size() + 16);
    state.ys.resize(pixels.size() + 16);
    for (size_t i = 0; i < pixels.size(); ++i) {
        state.xs[i] = tile.x + pattern.dx[pixels[i]];
        state.ys[i] = tile.y + pattern.dy[pixels[i]];
    }
}

/// Copies the elements with some numbers to the front of another list, or back.
template <typename T>
void copy_out(std::span<const uint32_t> numbers, const std::vector<T>& from, std::vector<T>& to) {
    to.resize(numbers.size());
    for (size_t i = 0; i < numbers.size(); ++i)
        to[i] = from[numbers[i]];
}

template <typename T>
void copy_back(std::span<const uint32_t> numbers, const std::vector<T>& from, std::vector<T>& to) {
    for (size_t i = 0; i < numbers.size(); ++i)
        to[numbers[i]] = from[i];
}

/// How many pixels and samples of each fill a batch: whole 4x4 blocks of pixels, and whole blocks
/// of samples, which sums add fastest, where there are so many.
///
/// In      pixels, samples: that there are, at least 1
std::pair<int, int> batch_shape(int pixels, int samples) {
    constexpr auto block = static_cast<int>(sum_block_samples);
    const int room = batch_size / std::min(samples, block) / 16 * 16;
    const int pixels_at_once = std::min(pixels, room);
    const int samples_at_once = batch_size / pixels_at_once;
    return {pixels_at_once,
            samples_at_once < block ? samples_at_once : samples_at_once / block * block};
}

/// Samples the pixels [first, first + count) of the list in `state`.
///
/// Out     whether all samples were taken: not when `work.stop` is set
bool sample_list(const TileWork& work,
                 std::span<const uint32_t> pixels,
                 const SampleRange& range,
                 ThreadState& state,
                 TileSums& sums) {
    WavefrontInput in = work.wavefront;
    in.recorder = state.recorder.get();
    const auto listed = static_cast<int>(pixels.size());
    for (int first = 0; first < listed;) {
        const auto [count, per_batch] = batch_shape(listed - first, range.count);
        in.batch.pixel_x = state.xs.data() + first;
        in.batch.pixel_y = state.ys.data() + first;
        const auto start = static_cast<size_t>(first);
        for (int done = 0; done < range.count; done += per_batch) {
            if (work.stop.load(std::memory_order_relaxed)) return false;
            in.batch.first_sample = range.first + static_cast<uint32_t>(done);
            in.batch.samples = std::min(per_batch, range.count - done);
            trace_batch(in, count, state.work, state.beauty.data() + first, state.counters);
            if (!state.catchers.empty()) {
                add_catcher_samples(state.work.catcher.samples,
                                    {in.batch.first_sample, in.batch.samples},
                                    std::span(state.catchers).subspan(start));
            }
            if (work.layers.empty()) continue;
            const SumOfTime time(state.counters.seconds.accumulate);
            const BatchShape shape{pixels.subspan(start, static_cast<size_t>(count)),
                                   static_cast<size_t>(in.batch.samples),
                                   static_cast<size_t>(in.batch.first_sample)};
            sums.layers.add(work.layers, shape, state.work);
        }
        first += count;
    }
    return true;
}

}  // namespace

std::vector<Tile> cut_tiles(const PixelRect& area, int size) {
    std::vector<Tile> tiles;
    for (int y = 0; y < area.height; y += size) {
        for (int x = 0; x < area.width; x += size) {
            tiles.push_back({area.x + x,
                             area.y + y,
                             std::min(size, area.width - x),
                             std::min(size, area.height - y)});
        }
    }
    std::sort(tiles.begin(), tiles.end(), [&](const Tile& a, const Tile& b) {
        return is_before(area, size, a, b);
    });
    return tiles;
}

const TilePattern& pattern_of(const Tile& tile, TilePattern& latest) {
    if (latest.width != tile.width || latest.height != tile.height)
        fill_pattern(tile.width, tile.height, latest);
    return latest;
}

void begin_tile(const TileWork& work, const Tile& tile, TileSums& sums) {
    const auto pixels = static_cast<size_t>(tile.width) * static_cast<size_t>(tile.height);
    sums.tile = tile;
    sums.beauty.assign(pixels, {});
    sums.catchers.assign(work.wavefront.catchers.any() ? pixels : 0, {});
    sums.layers.begin(work.layers, pixels);
    sums.samples.assign(pixels, 0);
}

void sample_pixels(const TileWork& work,
                   std::span<const uint32_t> pixels,
                   const SampleRange& range,
                   ThreadState& state,
                   TileSums& sums) {
    if (pixels.empty()) return;
    list_pixels(sums.tile, pixels, state);
    copy_out(pixels, sums.beauty, state.beauty);
    state.catchers.clear();
    if (!sums.catchers.empty()) copy_out(pixels, sums.catchers, state.catchers);
    if (!sample_list(work, pixels, range, state, sums)) return;
    copy_back(pixels, state.beauty, sums.beauty);
    if (!sums.catchers.empty()) copy_back(pixels, state.catchers, sums.catchers);
    for (const uint32_t pixel : pixels)
        sums.samples[pixel] += range.count;
}

void render_aov_tile(const TileWork& work, const Tile& tile, ThreadState& state, Film& film) {
    const TilePattern& pattern = pattern_of(tile, state.pattern);
    list_pixels(tile, pattern.all, state);
    const auto pixels = static_cast<int>(pattern.all.size());
    WavefrontInput in = work.wavefront;
    in.recorder = state.recorder.get();
    for (int first = 0; first < pixels; first += aov_batch_size) {
        if (work.stop.load(std::memory_order_relaxed)) return;
        const int count = std::min(aov_batch_size, pixels - first);
        in.batch.pixel_x = state.xs.data() + first;
        in.batch.pixel_y = state.ys.data() + first;
        trace_aov(in, count, state.work, state.counters);
        const SumOfTime time(state.counters.seconds.accumulate);
        write_film(state.work.samples, {in.batch.pixel_x, in.batch.pixel_y, count}, film);
    }
}

void store_beauty(const TileSums& sums, TilePattern& latest, Film& film) {
    const TilePattern& pattern = pattern_of(sums.tile, latest);
    const size_t channels = film.channels.size();
    for (size_t i = 0; i < sums.beauty.size(); ++i) {
        float* const out =
            film.pixels.data() +
            channels * pixel_index(film, sums.tile.x + pattern.dx[i], sums.tile.y + pattern.dy[i]);
        for (size_t c = 0; c < channels; ++c)
            out[c] = sums.beauty[i].mean(static_cast<int>(c), sums.samples[i]);
        if (!sums.catchers.empty()) {
            const std::array<float, 4> part =
                catcher_part(sums.catchers[i].total(), sums.samples[i]);
            for (size_t c = 0; c < channels; ++c)
                out[c] += part[c];
        }
        // Few paths through tinted glass may weigh more than all of the pixel.
        if (channels == 4) out[3] = std::max(out[3], 0.0f);
    }
}

void store_layers(const LayerPlan& plan, const TileSums& sums, TilePattern& latest, Film& film) {
    if (plan.empty()) return;
    const TilePattern& pattern = pattern_of(sums.tile, latest);
    std::vector<size_t> at;
    for (size_t i = 0; i < sums.samples.size(); ++i) {
        at.push_back(pixel_index(film, sums.tile.x + pattern.dx[i], sums.tile.y + pattern.dy[i]));
    }
    sums.layers.store(plan, {at, sums.samples, sums.catchers}, film);
}

}  // namespace obscura
