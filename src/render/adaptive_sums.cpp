// render/adaptive_sums.cpp - adaptive sampling: a film's sums, each pass for the pixels in need.
// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive_sums.h"

#include "base/parallel.h"
#include "render/pass_sums.h"
#include "render/sample_plan.h"

#include <algorithm>
#include <map>

namespace obscura {

namespace {

/// What a camera ray costs beside one that goes on from a surface: its neighbours go the same way.
constexpr double camera_ray_cost = 0.1;

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
      shape_(shape_of(film)),
      groups_{film.width, film.height},
      sizes_(groups_.sizes()),
      samples_(groups_.count(), 0),
      goals_(groups_.count(), levels_[1]),
      samples_before_(groups_.count(), 0),
      before_(film.pixels.size(), 0.0f) {
    static_assert(pass_tile_side % PixelGroups::block_side == 0);
    for (size_t i = 0; i < sizes_.size(); ++i) {
        if (sizes_[i] == 0) goals_[i] = 0;
    }
}

double AdaptiveSums::fraction() const {
    if (is_over_) return 1;
    const double part =
        passes_ == 0 ? mean_samples() / levels_[1]
                     : static_cast<double>(tiles_done_) / static_cast<double>(tiles().size());
    constexpr double most = 0.99;  // there may be more passes than levels
    return std::min((passes_ + part) / static_cast<double>(levels_.size() - 1), most);
}

/// Where the pixels of a tile lie, in the order of its pattern.
std::vector<AdaptiveSums::PixelPlace> AdaptiveSums::places(const Tile& tile,
                                                           TilePattern& latest) const {
    const TilePattern& pattern = pattern_of(tile, latest);
    const int x_0 = shape_.part_of ? shape_.part_of->x : 0;
    const int y_0 = shape_.part_of ? shape_.part_of->y : 0;
    std::vector<PixelPlace> out;
    out.reserve(pattern.all.size());
    for (size_t i = 0; i < pattern.all.size(); ++i) {
        const int x = tile.x + pattern.dx[i];
        const int y = tile.y + pattern.dy[i];
        out.push_back({pixel_index(shape_, x, y), groups_.of(x - x_0, y - y_0)});
    }
    return out;
}

/// The groups of a tile's pixels. A block of one pixel, in a corner, has one.
std::vector<size_t> AdaptiveSums::groups_in(const Tile& tile) const {
    constexpr int side = PixelGroups::block_side;
    const int x_0 = tile.x - (shape_.part_of ? shape_.part_of->x : 0);
    const int y_0 = tile.y - (shape_.part_of ? shape_.part_of->y : 0);
    std::vector<size_t> out;
    for (int y = y_0; y < y_0 + tile.height; y += side) {
        for (int x = x_0; x < x_0 + tile.width; x += side) {
            const size_t first = groups_.of(x, y);
            for (const size_t group : {first, first + 1}) {
                if (sizes_[group] > 0) out.push_back(group);
            }
        }
    }
    return out;
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

/// Samples the pixels that are short of their goals. Where somebody looks at the film soon, the
/// first pass is one of several over all of it, so that no part stays black for long.
void AdaptiveSums::run_pass(const FilmWork& work) {
    const FilmShare* const share = work.options.share;
    if (passes_ == 0 && share != nullptr && share->shows_early) {
        for (const int end : pass_ends(levels_[1], true)) {
            limit_ = end;
            sample_tiles(work);
        }
    }
    limit_ = max_samples_;
    sample_tiles(work);
}

/// The same of those that have fewer samples than limit_.
void AdaptiveSums::sample_tiles(const FilmWork& work) {
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
    bool has_sampled = false;
    while (!work.tile_work.stop.load(std::memory_order_relaxed)) {
        const std::lock_guard lock(tile.using_it);
        if (!take_next_samples(work, tile)) {
            if (has_sampled) store_beauty(tile.sums, state.pattern, work.film);
            return;
        }
        has_sampled = true;
        if (tile.samples > levels_.front()) continue;
        // The first of the two parts that the least number has.
        store_beauty(tile.sums, state.pattern, work.film);
        note_pixels(work.film, tile.tile, state.pattern);
    }
}

/// Takes samples of the pixels with fewest of those that are short of their goals. False: there are
/// none.
bool AdaptiveSums::take_next_samples(const FilmWork& work, SumsTile& tile) {
    const std::vector<size_t> groups = groups_in(tile.tile);
    const auto goal_of = [&](size_t group) { return std::min(goals_[group], limit_); };
    int first = max_samples_;
    for (const size_t group : groups) {
        if (samples_[group] < goal_of(group)) first = std::min(first, samples_[group]);
    }
    const auto is_next = [&](size_t group) {
        return samples_[group] == first && goal_of(group) > first;
    };
    int goal = first < levels_.front() ? levels_.front() : max_samples_;
    for (const size_t group : groups) {
        if (is_next(group)) goal = std::min(goal, goal_of(group));
    }
    std::vector<uint32_t> pixels;
    const std::vector<PixelPlace> all = places(tile.tile, thread_state(work).pattern);
    for (size_t i = 0; i < all.size(); ++i) {
        if (is_next(all[i].group)) pixels.push_back(static_cast<uint32_t>(i));
    }
    if (pixels.empty()) return false;
    const int count = std::min(goal - first, samples_at_once(pixels.size()));
    take_samples(work, pixels, {static_cast<uint32_t>(first), count}, tile);
    for (const size_t group : groups) {
        if (is_next(group)) samples_[group] += count;
    }
    return true;
}

/// Notes the pixels of a tile that go on as they are in the film.
void AdaptiveSums::note_pixels(const Film& film, const Tile& tile, TilePattern& latest) {
    const std::vector<size_t> groups = groups_in(tile);
    const auto goes_on = [&](size_t group) { return goals_[group] > samples_[group]; };
    if (std::none_of(groups.begin(), groups.end(), goes_on)) return;
    const size_t channels = film.channels.size();
    for (const auto& [at, group] : places(tile, latest)) {
        if (!goes_on(group)) continue;
        samples_before_[group] = samples_[group];
        std::copy_n(film.pixels.data() + at * channels, channels, before_.data() + at * channels);
    }
}

void AdaptiveSums::store_all(const FilmWork& work) const {
    parallel_for(tiles().size(), [&](size_t i) {
        const SumsTile& tile = tiles()[i];
        if (tile.samples > 0) store_beauty(tile.sums, thread_state(work).pattern, work.film);
    });
}

/// The mean number of rays that a sample takes, of each group: that of its tile, as rays are
/// counted there.
std::vector<float> AdaptiveSums::costs_of_groups() const {
    std::vector<float> out(groups_.count(), 1.0f);
    for (const SumsTile& tile : tiles()) {
        const RenderCounters& rays = tile.counters;
        if (rays.paths == 0) continue;
        const double cost = camera_ray_cost * static_cast<double>(rays.camera_rays) +
                            static_cast<double>(rays.bounce_rays) +
                            static_cast<double>(rays.shadow_rays);
        for (const size_t group : groups_in(tile.tile))
            out[group] = static_cast<float>(cost / static_cast<double>(rays.paths));
    }
    return out;
}

/// The noise of the film as it is.
std::vector<float> AdaptiveSums::deviations_of(const Film& film) const {
    return sample_deviations({.width = film.width,
                              .height = film.height,
                              .channels = film.channels.size(),
                              .pixels = std::span(film.pixels.data(), film.pixels.size()),
                              .before = before_,
                              .samples = samples_,
                              .samples_before = samples_before_,
                              .white = adaptive_.white});
}

/// Chooses the pixels of the next pass. False: no pixel is in need.
bool AdaptiveSums::begin_next_pass(const FilmWork& work) {
    const std::lock_guard lock(planning_);
    ++passes_;
    deviations_ = deviations_of(work.film);
    const std::vector<float> costs = costs_of_groups();
    goals_ = next_samples({deviations_, samples_, costs, sizes_}, adaptive_.noise_target, levels_);
    parallel_for(tiles().size(), [&](size_t i) {
        note_pixels(work.film, tiles()[i].tile, thread_state(work).pattern);
    });
    return goals_ != samples_;
}

SamplesTaken AdaptiveSums::taken() const {
    SamplesTaken out;
    out.passes = passes_;
    out.least = max_samples_;
    for (size_t i = 0; i < sizes_.size(); ++i) {
        if (sizes_[i] == 0) continue;
        out.least = std::min(out.least, samples_[i]);
        out.most = std::max(out.most, samples_[i]);
        out.pixels += static_cast<size_t>(sizes_[i]);
        out.total += static_cast<uint64_t>(samples_[i]) * static_cast<uint64_t>(sizes_[i]);
    }
    if (passes_ > 0) out.noise = image_noise(deviations_, samples_, groups_);
    return out;
}

void AdaptiveSums::put(StateWriter& out) const {
    const std::lock_guard lock(planning_);
    out.put_number(static_cast<uint64_t>(passes_));
    out.put_array(deviations_);
    FilmSums::put(out);
}

bool AdaptiveSums::take(const TileWork& work, StateReader& in) {
    passes_ = in.integer();
    deviations_.resize(passes_ > 0 ? groups_.count() : 0);
    in.take_array(deviations_);
    return FilmSums::take(work, in);
}

void AdaptiveSums::put_more(size_t tile, StateWriter& out) const {
    TilePattern pattern;
    const SumsTile& sums = tiles()[tile];
    const size_t channels = shape_.channels.size();
    std::vector<PixelPlan> plans;
    std::vector<float> before;
    for (const auto& [at, group] : places(sums.tile, pattern)) {
        plans.push_back({samples_[group], goals_[group], samples_before_[group]});
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
    const std::vector<PixelPlace> pixels = places(sums.tile, pattern);
    std::vector<PixelPlan> plans(pixels.size());
    std::vector<float> before(pixels.size() * channels);
    in.take_array(plans);
    in.take_array(before);
    std::map<size_t, PixelPlan> of_group;
    for (size_t i = 0; i < pixels.size(); ++i) {
        const auto& [at, group] = pixels[i];
        const PixelPlan& plan = plans[i];
        const bool is_in_order = plan.samples_before >= 0 && plan.samples_before <= plan.samples &&
                                 plan.samples <= plan.goal && plan.goal <= max_samples_;
        const bool is_as_its_group = of_group.try_emplace(group, plan).first->second == plan;
        if (!in.good() || !is_in_order || !is_as_its_group) return false;
        sums.sums.samples[i] = plan.samples;
        samples_[group] = plan.samples;
        goals_[group] = plan.goal;
        samples_before_[group] = plan.samples_before;
        std::copy_n(before.data() + i * channels, channels, before_.data() + at * channels);
    }
    return true;
}

}  // namespace obscura
