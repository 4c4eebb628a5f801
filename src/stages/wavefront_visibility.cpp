// stages/wavefront_visibility.cpp - holdouts, and light behind what casts no shadow.
// SPDX-License-Identifier: Apache-2.0
#include "stages/wavefront_visibility.h"

#include "stages/wavefront_catchers.h"
#include "stages/wavefront_slots.h"

#include <algorithm>

namespace obscura {

namespace {

constexpr float largest_density = 1.0f;  // 1/sr, of rays off surfaces that count as rough

}  // namespace

void part_camera_hits(const WavefrontInput& in, int count, Workspace& work) {
    const PathColumns& p = work.paths[0];
    if (in.catchers.any() || looks_through_glass(in)) begin_catchers(work);
    for (int i = 0; i < count; ++i) {
        const uint8_t flags = flags_of_hit(in, work.hits, i);
        if (meet_catcher(in, i, flags, work) || (flags & visibility_holdout) == 0) continue;
        work.hits.primitive[i] = -1;
        p.tr[i] = p.tg[i] = p.tb[i] = 0;
    }
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
