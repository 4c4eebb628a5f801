// stages/wavefront_catchers.cpp - shadow catchers and the background, directly or through glass.
// SPDX-License-Identifier: Apache-2.0
#include "stages/wavefront_catchers.h"

#include "math/vec.h"
#include "scene/scene.h"
#include "stages/wavefront_shadows.h"
#include "stages/wavefront_slots.h"
#include "stages/wavefront_visibility.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace obscura {

namespace {

/// Relative to the distance: a surface that lies on the ground goes before it.
constexpr float ground_clearance = 1e-5f;

/// Gives columns their memory, once.
template <typename Columns>
void allot(Columns& columns, std::byte*& next) {
    const auto take = [&](auto*& column) {
        column = reinterpret_cast<std::remove_reference_t<decltype(column)>>(next);
        next += padded_batch_size * 4;
    };
    Columns::for_each_column(take, columns);
}

void allot_catchers(CatcherWork& work) {
    if (!work.memory.empty()) return;
    constexpr size_t alignment = 64;
    constexpr size_t columns = 2 * column_count<PathColumns> + column_count<HitColumns>;
    static_assert(padded_batch_size * 4 % alignment == 0);
    work.memory.resize(columns * padded_batch_size * 4 + alignment);
    void* start = work.memory.data();
    size_t space = work.memory.size();
    auto* next = static_cast<std::byte*>(
        std::align(alignment, work.memory.size() - alignment, start, space));
    allot(work.paths, next);
    allot(work.hits, next);
    allot(work.reflections, next);
    work.by_slot.resize(padded_batch_size);
}

Vec3f throughput_of(const PathColumns& p, int i) {
    return {p.tr[i], p.tg[i], p.tb[i]};
}

void set_throughput(const PathColumns& p, int i, const Vec3f& throughput) {
    p.tr[i] = throughput.x;
    p.tg[i] = throughput.y;
    p.tb[i] = throughput.z;
}

/// What one alpha can hold of a colour of glass.
float mean_of(const Vec3f& throughput) {
    return (throughput.x + throughput.y + throughput.z) * (1.0f / 3);
}

/// Adds a path to those at catchers, without what it hit. Returns its index in columns.
int add_catcher_path(int i, Workspace& work) {
    CatcherWork& catcher = work.catcher;
    const PathColumns& p = work.paths[0];
    const auto number = static_cast<int>(catcher.samples.size());
    copy_entry(p, i, catcher.paths, number - catcher.first);
    catcher.by_slot[p.slot[i]] = number;
    catcher.samples.push_back({.slot = p.slot[i]});
    return number - catcher.first;
}

/// The ground takes the place of what a ray hit.
void hit_ground(const HitColumns& hits, int i, float distance) {
    hits.primitive[i] = -1;
    hits.t[i] = distance;
}

/// Distance along a ray to the ground, which is seen from above only.
///
/// In      below: how far below the ground the ray may begin, metres
std::optional<float> distance_to_ground(const PathColumns& p, int i, float ground_m, float below) {
    if (!(p.oy[i] > ground_m - below) || !(p.dy[i] < 0.0f)) return std::nullopt;
    return std::max((ground_m - p.oy[i]) / p.dy[i], 0.0f);
}

/// What a medium that does not scatter leaves of the light on the way to a catcher.
Vec3f transmittance_to_catcher(const SceneView& scene, uint32_t medium_stack, float distance) {
    const Vec3f all{1, 1, 1};
    const uint32_t number = medium_stack >> 16U & 255U;
    if (scene.media == nullptr || number == 0) return all;
    const Medium& medium = scene.media[number];
    if (scatters(medium)) return all;
    return {std::exp(-medium.extinction[0] * distance),
            std::exp(-medium.extinction[1] * distance),
            std::exp(-medium.extinction[2] * distance)};
}

/// The paths of work.paths[0] that have met nothing but clear glass.
void list_clear_paths(int count, Workspace& work) {
    const PathColumns& p = work.paths[0];
    std::vector<int32_t>& clear = work.catcher.clear;
    clear.clear();
    for (int i = 0; i < count; ++i) {
        if ((p.medium_stack[i] & seen_unclearly) == 0 && max_component(throughput_of(p, i)) > 0)
            clear.push_back(i);
    }
}

/// Traces these paths again with catchers in place, which rays beyond the first pass.
///
/// Out     work.random_walk_hits, by index in work.catcher.clear
void trace_to_catchers(const WavefrontInput& in,
                       int bounce,
                       Workspace& work,
                       WavefrontCounters& c) {
    const auto count = static_cast<int>(work.catcher.clear.size());
    for (int k = 0; k < count; ++k)
        copy_entry(work.paths[0], work.catcher.clear[static_cast<size_t>(k)], work.paths[1], k);
    RayColumns rays = rays_of(work.paths[1], count);
    rays.time = times_of(in, work.paths[1].slot, count, work);
    count_rays(in, work.paths[1].slot, count, work);
    const SeeThrough see_through{.segment = 2U * static_cast<uint32_t>(bounce),
                                 .cutaway = cut_away(work.paths[1].slot, work)};
    c.bounce_rays += static_cast<uint64_t>(count);
    c.refused_rays += static_cast<uint64_t>(
        in.accel->intersect(rays, work.random_walk_hits, Coherence::incoherent, see_through));
}

/// Lets a path through glass meet the catcher that is the nearest of what it hit.
///
/// In      hits, at: what it hit, catchers included
bool meet_beyond_glass(
    const WavefrontInput& in, int i, const HitColumns& hits, int at, Workspace& work) {
    const PathColumns& p = work.paths[0];
    const float nearest = hits.primitive[at] >= 0 ? hits.t[at] : unlimited;
    std::optional<float> ground;
    if (in.catchers.ground_m)
        ground = distance_to_ground(p, i, *in.catchers.ground_m, in.catchers.below_ground_m);
    const bool on_ground = ground && *ground * (1.0f + ground_clearance) < nearest;
    if (!on_ground && (flags_of_hit(in, hits, at) & visibility_catcher) == 0) return false;
    const int number = add_catcher_path(i, work);
    CatcherWork& catcher = work.catcher;
    copy_entry(hits, at, catcher.hits, number);
    if (on_ground) hit_ground(catcher.hits, number, *ground);
    const Vec3f throughput =
        throughput_of(p, i) *
        transmittance_to_catcher(in.scene, p.medium_stack[i], catcher.hits.t[number]);
    set_throughput(catcher.paths, number, throughput);
    CatcherSample& sample = catcher.samples.back();
    sample.transmitted = mean_of(throughput);
    work.samples.a[sample.slot] -= sample.transmitted;
    return true;
}

bool shows_environment(const WavefrontInput& in) {
    return in.batch.background_visible && in.scene.has_environment;
}

/// Lets a path through glass see the background, which is no environment.
void see_background(const WavefrontInput& in, int i, Workspace& work) {
    const float* const background = in.batch.background;
    const uint32_t slot = work.paths[0].slot[i];
    const Vec3f throughput = throughput_of(work.paths[0], i);
    const SampleColumns& samples = work.samples;
    samples.a[slot] -= mean_of(throughput) * (1.0f - background[3]);
    const Vec3f seen = throughput * Vec3f{background[0], background[1], background[2]};
    samples.r[slot] += seen.x;
    samples.g[slot] += seen.y;
    samples.b[slot] += seen.z;
    if (in.light_paths != nullptr)
        work.light_paths.add_path_light(slot, background_class(*in.light_paths), seen);
}

/// The environment behind catchers that are seen through glass.
///
/// Out     work.samples: its light, and nothing else
void see_environment_behind(const WavefrontInput& in, int count, Workspace& work) {
    const CatcherWork& catcher = work.catcher;
    for (int k = 0; k < count; ++k) {
        copy_entry(catcher.paths, k, work.paths[1], k);
        work.hits.primitive[k] = -1;
    }
    in.stages->shade(in.scene,
                     in.batch,
                     0,
                     count,
                     {.paths = work.paths[1],
                      .hits = work.hits,
                      .misses = work.misses,
                      .next = work.paths[1],
                      .shadows = work.shadows,
                      .samples = work.samples});
}

/// The catchers that paths met at the latest bounce.
std::span<CatcherSample> latest(CatcherWork& catcher) {
    return std::span(catcher.samples).subspan(static_cast<size_t>(catcher.first));
}

/// Takes a colour out of work.samples.
void take_color(const SampleColumns& samples, uint32_t slot, float* color) {
    color[0] = std::exchange(samples.r[slot], 0.0f);
    color[1] = std::exchange(samples.g[slot], 0.0f);
    color[2] = std::exchange(samples.b[slot], 0.0f);
}

/// Camera rays at catchers were shaded as misses: what their samples have lies behind the catchers.
void take_background(const WavefrontInput& in, Workspace& work) {
    for (CatcherSample& sample : latest(work.catcher)) {
        take_color(work.samples, sample.slot, sample.background);
        sample.background[3] = std::exchange(work.samples.a[sample.slot], 0.0f);
        if (in.light_paths != nullptr) work.light_paths.move_behind(sample.slot);
    }
}

/// What lies behind catchers that are seen through glass; their samples have what lies in front.
void find_background(const WavefrontInput& in, Workspace& work) {
    const std::span<CatcherSample> met = latest(work.catcher);
    const SampleColumns& samples = work.samples;
    const float* const background = in.batch.background;
    std::vector<float> alpha;
    for (CatcherSample& sample : met) {
        take_color(samples, sample.slot, sample.front);
        alpha.push_back(samples.a[sample.slot]);
        const Vec3f through =
            throughput_of(work.catcher.paths, static_cast<int>(&sample - met.data()));
        const Vec3f seen = through * Vec3f{background[0], background[1], background[2]};
        sample.background[0] = seen.x;
        sample.background[1] = seen.y;
        sample.background[2] = seen.z;
        sample.background[3] = sample.transmitted * background[3];
    }
    if (shows_environment(in)) {
        see_environment_behind(in, static_cast<int>(met.size()), work);
        for (size_t k = 0; k < met.size(); ++k) {
            take_color(samples, met[k].slot, met[k].background);
            samples.a[met[k].slot] = alpha[k];
        }
    }
    if (in.light_paths == nullptr) return;
    for (const CatcherSample& sample : met) {
        const float* const seen = sample.background;
        work.light_paths.add_behind(
            sample.slot, background_class(*in.light_paths), {seen[0], seen[1], seen[2]});
    }
}

}  // namespace

void begin_catchers(Workspace& work) {
    allot_catchers(work.catcher);
    work.catcher.samples.clear();
    work.catcher.first = 0;
    work.catcher.reflected.clear();
}

bool meet_catcher(const WavefrontInput& in, int i, uint8_t flags, Workspace& work) {
    if (!in.catchers.any() || work.paths[0].tr[i] == 0) return false;  // outside the image
    const HitColumns& hits = work.hits;
    std::optional<float> ground;
    if (in.catchers.ground_m)
        ground = distance_to_ground(work.paths[0], i, *in.catchers.ground_m, 0.0f);
    const float clip =
        limits_rays(in.batch.camera) ? work.camera_length_m[static_cast<size_t>(i)] : unlimited;
    const float nearest = hits.primitive[i] >= 0 ? hits.t[i] : clip;
    if (ground && *ground * (1.0f + ground_clearance) < nearest) {
        hit_ground(hits, i, *ground);
    } else if (!in.catchers.surfaces || (flags & visibility_catcher) == 0) {
        return false;
    }
    copy_entry(hits, i, work.catcher.hits, add_catcher_path(i, work));
    hits.primitive[i] = -1;
    return true;
}

void look_through_glass(
    const WavefrontInput& in, int bounce, int count, Workspace& work, WavefrontCounters& c) {
    CatcherWork& catcher = work.catcher;
    list_clear_paths(count, work);
    catcher.ended.clear();
    if (in.catchers.surfaces) trace_to_catchers(in, bounce, work, c);
    for (size_t k = 0; k < catcher.clear.size(); ++k) {
        const int i = catcher.clear[k];
        const HitColumns& hits = in.catchers.surfaces ? work.random_walk_hits : work.hits;
        const int at = in.catchers.surfaces ? static_cast<int>(k) : i;
        if (in.catchers.any() && meet_beyond_glass(in, i, hits, at, work)) {
            work.hits.primitive[i] = -1;
        } else if (work.hits.primitive[i] < 0 && !shows_environment(in)) {
            see_background(in, i, work);
        } else {
            continue;
        }
        catcher.ended.push_back(i);
    }
}

void end_behind_glass(Workspace& work) {
    for (const int i : work.catcher.ended)
        set_throughput(work.paths[0], i, {0, 0, 0});
}

CatcherCounts leave_catchers(const WavefrontInput& in, int bounce, int count, Workspace& work) {
    CatcherWork& catcher = work.catcher;
    const int met = static_cast<int>(catcher.samples.size()) - catcher.first;
    if (bounce == 0) {
        take_background(in, work);
    } else {
        find_background(in, work);
    }
    const int reflections = catcher.reflected.empty()
                                ? 0
                                : catcher.reflected.back().first + catcher.reflected.back().count;
    const CatcherColumns columns{.paths = catcher.paths,
                                 .hits = catcher.hits,
                                 .next = work.paths[0],
                                 .reflections = catcher.reflections,
                                 .shadows = work.shadows,
                                 .time = slot_times(in, work),
                                 .lit_points = lit_points(in, work),
                                 .ground_m = in.catchers.ground_m.value_or(0.0f),
                                 .bounce = bounce,
                                 .first_next = count,
                                 .first_reflection = reflections,
                                 .reflects = in.catchers.reflects};
    const CatcherCounts out = in.stages->shade_catchers(in.scene, met, columns);
    if (out.reflections > reflections)
        catcher.reflected.push_back({bounce, reflections, out.reflections - reflections});
    const ShadowColumns& s = work.shadows;
    uint32_t* const media = shadow_media(in, work);
    for (int i = 0; i < out.shadow; ++i) {
        const int number = catcher.by_slot[s.slot[i]];
        catcher.samples[static_cast<size_t>(number)].unshadowed =
            luminance(Vec3f{s.r[i], s.g[i], s.b[i]});
        if (media != nullptr) media[s.slot[i]] = catcher.paths.medium_stack[number - catcher.first];
    }
    for (const CatcherSample& sample : latest(catcher)) {
        // What samples keep of the glass in front of the catcher ends.
        if (in.scene.thin_walls) work.distance_since_scattering[sample.slot] = 0;
        if (in.scene.occludes) work.occlusion[sample.slot] = 1;
        if (in.light_paths != nullptr) work.light_paths.hold(sample.slot);
    }
    catcher.first += met;
    return out;
}

uint64_t settle_catchers(Workspace& work) {
    const SampleColumns& samples = work.samples;
    std::vector<CatcherSample>& all = work.catcher.samples;
    uint64_t nonfinite = 0;
    for (CatcherSample& sample : all) {
        const uint32_t slot = sample.slot;
        sample.shadowed = luminance(Vec3f{samples.r[slot], samples.g[slot], samples.b[slot]});
        samples.r[slot] = sample.front[0];
        samples.g[slot] = sample.front[1];
        samples.b[slot] = sample.front[2];
        if (sample.shadowed <= largest_sample && sample.unshadowed <= largest_sample) continue;
        sample.shadowed = sample.unshadowed = 0;
        ++nonfinite;
    }
    // Sums must not depend on which samples share a batch.
    std::sort(all.begin(), all.end(), [](const CatcherSample& a, const CatcherSample& b) {
        return a.slot < b.slot;
    });
    return nonfinite;
}

void take_reflections(const CatcherReflections& reflections, Workspace& work) {
    const auto column = [&](const auto* from, auto* to) {
        std::copy_n(from + reflections.first, reflections.count, to);
    };
    PathColumns::for_each_column(column, work.catcher.reflections, work.paths[0]);
}

int keep_hits(int count, Workspace& work) {
    int kept = 0;
    for (int i = 0; i < count; ++i) {
        if (work.hits.primitive[i] >= 0) copy_entry(work.paths[0], i, work.paths[0], kept++);
    }
    return kept;
}

}  // namespace obscura
