// render/adaptive_sums.cpp - adaptive sampling: a film's sums, each pass for the pixels in need.
// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive_sums.h"

#include "base/parallel.h"
#include "film/noise.h"
#include "render/sample_plan.h"

#include <algorithm>

namespace obscura {

namespace {

/// The first passes, to the least number of samples, take all pixels.
constexpr int passes_of_all = 2;

/// How many samples of some pixels are taken at once: enough to fill batches where few pixels are
/// left, and few enough that nobody waits long for the tile. Whole multiples of 16, so that the
/// halves which are compared stay equal.
int samples_at_once(size_t pixels) {
    constexpr size_t work = size_t{1} << 16;
    return static_cast<int>(std::max<size_t>(work / pixels / 16 * 16, 64));
}

Film shape_of(const Film& film) {
    Film out;
    out.width = film.width;
    out.height = film.height;
    out.channels = film.channels;
    out.part_of = film.part_of;
    return out;
}

}  // namespace

AdaptiveSums::AdaptiveSums(const std::vector<Tile>& tiles,
                           const RenderOptions& options,
                           const Film& film)
    : FilmSums(tiles),
      adaptive_(*options.adaptive),
      max_samples_(options.samples_per_pixel),
      levels_(sample_levels(adaptive_.min_samples, max_samples_)),
      shape_(shape_of(film)) {
    const size_t pixels = film.pixels.size() / film.channels.size();
    started_.assign(pixels, 0);
    goals_.assign(pixels, levels_.front());
    before_.assign(film.pixels.size(), 0.0f);
    samples_before_.assign(pixels, 0);
}

double AdaptiveSums::fraction() const {
    if (is_over_) return 1;
    const double part = static_cast<double>(tiles_done_) / static_cast<double>(tiles().size());
    return std::min((passes_ + part) / static_cast<double>(levels_.size()), 1.0);
}

/// The film's index of each pixel of a tile, in the order of its pattern.
std::vector<size_t> AdaptiveSums::film_indices(const Tile& tile, TilePattern& latest) const {
    const TilePattern& pattern = pattern_of(tile, latest);
    std::vector<size_t> at;
    for (size_t i = 0; i < pattern.all.size(); ++i)
        at.push_back(pixel_index(shape_, tile.x + pattern.dx[i], tile.y + pattern.dy[i]));
    return at;
}

void AdaptiveSums::sample(const FilmWork& work) {
    // Where the sums have been taken from a file, the film has nothing of them yet.
    if (samples() > 0) store_all(work);
    do {
        run_pass(work);
        if (work.tile_work.stop) return;
    } while (begin_next_pass(work));
    is_over_ = true;
    // Only now it is known that no pass follows.
    const Tile& first = tiles().front().tile;
    if (work.progress)
        work.progress({1.0, {first.x, first.y, first.width, first.height}, &work.film});
}

/// Samples the pixels that are short of their goals.
void AdaptiveSums::run_pass(const FilmWork& work) {
    const std::atomic<bool>& stop = work.tile_work.stop;
    tiles_done_ = 0;
    parallel_for(tiles().size(), [&](size_t i) {
        sample_tile(work, tiles()[i]);
        if (stop.load(std::memory_order_relaxed)) return;
        ++tiles_done_;
        const Tile& area = tiles()[i].tile;
        if (work.progress)
            work.progress({fraction(), {area.x, area.y, area.width, area.height}, &work.film});
    });
}

void AdaptiveSums::sample_tile(const FilmWork& work, SumsTile& tile) {
    ThreadState& state = thread_state(work);
    const std::vector<size_t> at = film_indices(tile.tile, state.pattern);
    bool has_sampled = false;
    while (!work.tile_work.stop.load(std::memory_order_relaxed)) {
        const std::lock_guard lock(tile.using_it);
        if (!take_next_samples(work, at, tile)) {
            if (has_sampled) store_beauty(tile.sums, state.pattern, work.film);
            return;
        }
        has_sampled = true;
    }
}

/// Takes samples of the pixels with fewest of those that are short of their goals. False: there are
/// none.
bool AdaptiveSums::take_next_samples(const FilmWork& work,
                                     const std::vector<size_t>& at,
                                     SumsTile& tile) {
    const auto samples_of = [&](size_t i) { return tile.samples > 0 ? tile.sums.samples[i] : 0; };
    int first = max_samples_;
    for (size_t i = 0; i < at.size(); ++i) {
        if (samples_of(i) < goals_[at[i]]) first = std::min(first, samples_of(i));
    }
    std::vector<uint32_t> pixels;
    int goal = first;
    for (size_t i = 0; i < at.size(); ++i) {
        if (samples_of(i) != first || goals_[at[i]] <= first) continue;
        pixels.push_back(static_cast<uint32_t>(i));
        goal = goals_[at[i]];  // which follows from the samples
        if (started_[at[i]] == first) note_pixel(work.film, at[i]);
    }
    if (pixels.empty()) return false;
    const int count = std::min(goal - first, samples_at_once(pixels.size()));
    take_samples(work, pixels, {static_cast<uint32_t>(first), count}, tile);
    return true;
}

/// Notes a pixel of the film as it is before its samples of a pass.
void AdaptiveSums::note_pixel(const Film& film, size_t at) {
    samples_before_[at] = started_[at];
    if (started_[at] == 0) return;
    const size_t channels = film.channels.size();
    std::copy_n(film.pixels.data() + at * channels, channels, before_.data() + at * channels);
}

void AdaptiveSums::store_all(const FilmWork& work) const {
    parallel_for(tiles().size(), [&](size_t i) {
        const SumsTile& tile = tiles()[i];
        if (tile.samples > 0) store_beauty(tile.sums, thread_state(work).pattern, work.film);
    });
}

/// The samples of all pixels, by the film's index.
std::vector<int> AdaptiveSums::samples_of_film() const {
    std::vector<int> out(started_.size(), 0);
    TilePattern pattern;
    for (const SumsTile& tile : tiles()) {
        if (tile.samples == 0) continue;
        const std::vector<size_t> at = film_indices(tile.tile, pattern);
        for (size_t i = 0; i < at.size(); ++i)
            out[at[i]] = tile.sums.samples[i];
    }
    return out;
}

/// The noise of the film as it is.
std::vector<float> AdaptiveSums::deviations_of(const Film& film,
                                               std::span<const int> samples) const {
    return sample_deviations({.width = film.width,
                              .height = film.height,
                              .channels = film.channels.size(),
                              .pixels = std::span(film.pixels.data(), film.pixels.size()),
                              .before = before_,
                              .samples = samples,
                              .samples_before = samples_before_,
                              .white = adaptive_.white});
}

/// Chooses the pixels of the next pass. False: no pixel is in need.
bool AdaptiveSums::begin_next_pass(const FilmWork& work) {
    const std::lock_guard lock(planning_);
    ++passes_;
    started_ = samples_of_film();
    std::vector<uint8_t> wanted(started_.size(), 1);
    if (passes_ >= passes_of_all) {
        const std::vector<float> deviations = deviations_of(work.film, started_);
        wanted = pixels_in_need(deviations, started_, {adaptive_.noise_target, max_samples_});
    }
    bool any = false;
    for (size_t i = 0; i < wanted.size(); ++i) {
        goals_[i] = started_[i];
        if (wanted[i] == 0) continue;
        goals_[i] = *std::upper_bound(levels_.begin(), levels_.end(), started_[i]);
        any = true;
    }
    return any;
}

SamplesTaken AdaptiveSums::taken(const Film& film) const {
    const std::vector<int> samples = samples_of_film();
    SamplesTaken out;
    out.passes = passes_;
    out.pixels = samples.size();
    const auto [least, most] = std::minmax_element(samples.begin(), samples.end());
    out.least = *least;
    out.most = *most;
    for (const int count : samples)
        out.total += static_cast<uint64_t>(count);
    if (passes_ >= passes_of_all) out.noise = image_noise(deviations_of(film, samples), samples);
    return out;
}

void AdaptiveSums::put(StateWriter& out) const {
    const std::lock_guard lock(planning_);
    out.put_number(static_cast<uint64_t>(passes_));
    FilmSums::put(out);
}

bool AdaptiveSums::take(const TileWork& work, StateReader& in) {
    passes_ = in.integer();
    return FilmSums::take(work, in);
}

void AdaptiveSums::put_more(size_t tile, StateWriter& out) const {
    TilePattern pattern;
    const SumsTile& sums = tiles()[tile];
    const size_t channels = shape_.channels.size();
    std::vector<PixelPlan> plans;
    std::vector<float> before;
    for (const size_t at : film_indices(sums.tile, pattern)) {
        plans.push_back(
            {sums.sums.samples[plans.size()], started_[at], goals_[at], samples_before_[at]});
        const auto pixel = before_.begin() + static_cast<ptrdiff_t>(at * channels);
        before.insert(before.end(), pixel, pixel + static_cast<ptrdiff_t>(channels));
    }
    out.put_array(plans);
    out.put_array(before);
}

bool AdaptiveSums::take_more(size_t tile, StateReader& in) {
    TilePattern pattern;
    SumsTile& sums = tiles()[tile];
    const size_t channels = shape_.channels.size();
    const std::vector<size_t> at = film_indices(sums.tile, pattern);
    std::vector<PixelPlan> plans(at.size());
    std::vector<float> before(at.size() * channels);
    in.take_array(plans);
    in.take_array(before);
    for (size_t i = 0; i < at.size(); ++i) {
        const PixelPlan& plan = plans[i];
        const bool is_in_order = plan.samples_before >= 0 && plan.samples_before <= plan.started &&
                                 plan.started <= plan.samples && plan.samples <= plan.goal &&
                                 plan.goal <= max_samples_;
        if (!in.good() || !is_in_order) return false;
        sums.sums.samples[i] = plan.samples;
        started_[at[i]] = plan.started;
        goals_[at[i]] = plan.goal;
        samples_before_[at[i]] = plan.samples_before;
        std::copy_n(before.data() + i * channels, channels, before_.data() + at[i] * channels);
    }
    return true;
}

}  // namespace obscura
