// stages/wavefront_visibility.cpp - holdouts, catchers, and light behind what casts no shadow.
// SPDX-License-Identifier: Apache-2.0
#include "stages/wavefront_visibility.h"

#include "math/vec.h"
#include "stages/wavefront_shadows.h"
#include "stages/wavefront_slots.h"

#include <algorithm>
#include <memory>
#include <optional>

namespace obscura {

namespace {

/// Relative to the distance: a surface that lies on the ground goes before it.
constexpr float ground_clearance = 1e-5f;

constexpr float largest_density = 1.0f;  // 1/sr, of rays off surfaces that count as rough

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

/// Copies entry `from` of columns to entry `to` of others.
template <typename Columns>
void copy_entry(const Columns& columns, int from, const Columns& out, int to) {
    const auto column = [&](const auto* source, auto* target) { target[to] = source[from]; };
    Columns::for_each_column(column, columns, out);
}

/// Distance along a camera ray to the ground, which is seen from above only.
std::optional<float> distance_to_ground(const PathColumns& p, int i, float ground_m) {
    if (!(p.oy[i] > ground_m) || !(p.dy[i] < 0.0f)) return std::nullopt;
    return (ground_m - p.oy[i]) / p.dy[i];
}

/// Whether a catcher is what camera ray i meets first; then work.hits says where.
bool meets_catcher(const WavefrontInput& in, int i, uint8_t flags, Workspace& work) {
    if (!in.catchers.any() || work.paths[0].tr[i] == 0) return false;  // outside the image
    const HitColumns& hits = work.hits;
    if (in.catchers.ground_m) {
        const auto ground = distance_to_ground(work.paths[0], i, *in.catchers.ground_m);
        const float clip =
            limits_rays(in.batch.camera) ? work.camera_length_m[static_cast<size_t>(i)] : unlimited;
        const float nearest = hits.primitive[i] >= 0 ? hits.t[i] : clip;
        if (ground && *ground * (1.0f + ground_clearance) < nearest) {
            hits.primitive[i] = -1;
            hits.t[i] = *ground;
            return true;
        }
    }
    return in.catchers.surfaces && (flags & visibility_catcher) != 0;
}

uint8_t flags_of_hit(const WavefrontInput& in, const HitColumns& hits, int i) {
    if (in.visibility == nullptr || hits.primitive[i] < 0) return 0;
    return in.visibility->of(hits.primitive[i], hits.instance[i]);
}

}  // namespace

void part_camera_hits(const WavefrontInput& in, int count, Workspace& work) {
    CatcherWork& catcher = work.catcher;
    if (in.catchers.any()) allot_catchers(catcher);
    catcher.samples.clear();
    const PathColumns& p = work.paths[0];
    for (int i = 0; i < count; ++i) {
        const uint8_t flags = flags_of_hit(in, work.hits, i);
        if (meets_catcher(in, i, flags, work)) {
            const auto number = static_cast<int>(catcher.samples.size());
            copy_entry(p, i, catcher.paths, number);
            copy_entry(work.hits, i, catcher.hits, number);
            catcher.by_slot[p.slot[i]] = number;
            catcher.samples.push_back({.slot = p.slot[i]});
            work.hits.primitive[i] = -1;
        } else if ((flags & visibility_holdout) != 0) {
            work.hits.primitive[i] = -1;
            p.tr[i] = p.tg[i] = p.tb[i] = 0;
        }
    }
}

CatcherCounts leave_catchers(const WavefrontInput& in, int count, Workspace& work) {
    CatcherWork& catcher = work.catcher;
    const SampleColumns& samples = work.samples;
    for (CatcherSample& sample : catcher.samples) {
        size_t channel = 0;
        for (float* column : {samples.r, samples.g, samples.b, samples.a}) {
            sample.background[channel++] = column[sample.slot];
            column[sample.slot] = 0;
        }
    }
    const CatcherColumns columns{.paths = catcher.paths,
                                 .hits = catcher.hits,
                                 .next = work.paths[0],
                                 .reflections = catcher.reflections,
                                 .shadows = work.shadows,
                                 .time = slot_times(in, work),
                                 .ground_m = in.catchers.ground_m.value_or(0.0f),
                                 .first_next = count,
                                 .reflects = in.catchers.reflects};
    const CatcherCounts out =
        in.stages->shade_catchers(in.scene, static_cast<int>(catcher.samples.size()), columns);
    catcher.reflection_count = out.reflections;
    const ShadowColumns& s = work.shadows;
    uint32_t* const media = shadow_media(in, work);
    for (int i = 0; i < out.shadow; ++i) {
        const auto number = static_cast<size_t>(catcher.by_slot[s.slot[i]]);
        catcher.samples[number].unshadowed = luminance(Vec3f{s.r[i], s.g[i], s.b[i]});
        if (media != nullptr) media[s.slot[i]] = catcher.paths.medium_stack[number];
    }
    return out;
}

uint64_t settle_catchers(Workspace& work) {
    const SampleColumns& samples = work.samples;
    uint64_t nonfinite = 0;
    for (CatcherSample& sample : work.catcher.samples) {
        const uint32_t slot = sample.slot;
        sample.shadowed = luminance(Vec3f{samples.r[slot], samples.g[slot], samples.b[slot]});
        for (float* column : {samples.r, samples.g, samples.b})
            column[slot] = 0;
        if (sample.shadowed <= largest_sample && sample.unshadowed <= largest_sample) continue;
        sample.shadowed = sample.unshadowed = 0;
        ++nonfinite;
    }
    return nonfinite;
}

int take_reflections(Workspace& work) {
    const int count = work.catcher.reflection_count;
    const auto column = [&](const auto* from, auto* to) { std::copy_n(from, count, to); };
    PathColumns::for_each_column(column, work.catcher.reflections, work.paths[0]);
    work.catcher.reflection_count = 0;
    return count;
}

int keep_hits(int count, Workspace& work) {
    int kept = 0;
    for (int i = 0; i < count; ++i) {
        if (work.hits.primitive[i] >= 0) copy_entry(work.paths[0], i, work.paths[0], kept++);
    }
    return kept;
}

namespace {

/// Copies to work.paths[1] the bounced rays that hit a surface that casts no shadow. Returns their
/// number.
int seek_light_behind(const WavefrontInput& in, int count, Workspace& work) {
    const PathColumns& p = work.paths[0];
    const PathColumns& out = work.paths[1];
    int behind = 0;
    for (int i = 0; i < count; ++i) {
        if ((flags_of_hit(in, work.hits, i) & visibility_no_shadow) == 0) continue;
        if (!(p.pdf[i] > 0)) continue;
        copy_entry(p, i, out, behind);
        const float part = std::min(1.0f, largest_density / p.pdf[i]);
        for (float* column : {out.tr, out.tg, out.tb})
            column[behind] *= part;
        ++behind;
    }
    return behind;
}

}  // namespace

void add_light_behind(const LitBounce& lit, int count, Workspace& work, WavefrontCounters& c) {
    const WavefrontInput& in = lit.in;
    const int behind = seek_light_behind(in, count, work);
    if (behind == 0) return;
    ShadeColumns columns = lit.columns;
    columns.paths = work.paths[1];
    columns.hits = work.random_walk_hits;
    columns.distance_since_scattering = nullptr;  // thin walls end these rays
    RayColumns rays = rays_of(columns.paths, behind);
    rays.time = times_of(in, columns.paths.slot, behind, work);
    const SeeThrough see_through{.segment = 2U * static_cast<uint32_t>(lit.bounce),
                                 .passes = bounce_rays_pass | visibility_no_shadow,
                                 .cutaway = cut_away(columns.paths.slot, work)};
    c.bounce_rays += static_cast<uint64_t>(behind);
    c.refused_rays += static_cast<uint64_t>(
        in.accel->intersect(rays, columns.hits, Coherence::incoherent, see_through));
    BatchSettings batch = in.batch;
    batch.max_bounces = -1;  // they collect light and end
    in.stages->shade(in.scene, batch, lit.bounce, behind, columns);
}

}  // namespace obscura
