// stages/wavefront_shadows.cpp - stage 4: shadow rays through thin walls and boundaries of media.
// SPDX-License-Identifier: Apache-2.0
#include "stages/wavefront_shadows.h"

#include "base/stopwatch.h"
#include "stages/wavefront_light_paths.h"
#include "stages/wavefront_slots.h"
#include "stages/wavefront_splats.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace obscura {

namespace {

/// Attenuates the shadow rays that meet nothing by the medium around them.
void absorb_unhindered(const WavefrontInput& in, int count, Workspace& work) {
    const uint32_t* const media = shadow_media(in, work);
    if (media == nullptr) return;
    in.stages->absorb_shadows(in.scene,
                              count,
                              {.shadows = work.shadows,
                               .hits = {},
                               .occluded = work.occluded.data(),
                               .shadow_media = media});
}

/// Attenuates the shadow rays that wait, up to what they hit next or else to their lights.
void absorb_up_to_hits(const WavefrontInput& in, int count, Workspace& work) {
    const uint32_t* const media = shadow_media(in, work);
    if (media == nullptr) return;
    in.stages->absorb_shadows(
        in.scene,
        count,
        {.shadows = work.shadows, .hits = work.random_walk_hits, .shadow_media = media});
}

/// Whether all these boundaries are one: of the same medium, and from the same side.
bool is_one_boundary(const std::vector<Crossing>& faces) {
    return std::all_of(faces.begin(), faces.end(), [&](const Crossing& face) {
        return face.medium == faces[0].medium && face.enters == faces[0].enters;
    });
}

/// Ends the shadow rays whose hits coincide with faces of other media, as light sampling does not
/// reach through these: paths cross them all at once (stages/shared_faces.h).
void end_at_shared_faces(const WavefrontInput& in,
                         const RayColumns& rays,
                         const SeeThrough& see_through,
                         Workspace& work) {
    if (in.scene.touching_media == nullptr || shadow_media(in, work) == nullptr) return;
    constexpr float rounding = 2e-5f;  // of coordinates; more than coincidence_distance
    std::vector<Crossing> faces;
    for (int i = 0; i < rays.count; ++i) {
        const int32_t primitive = work.random_walk_hits.primitive[i];
        if (primitive < 0 || in.scene.touching_media[primitive] == 0) continue;
        const float t = work.random_walk_hits.t[i];
        const Vec3f origin{rays.ox[i], rays.oy[i], rays.oz[i]};
        const float near = rounding * (max_component(abs(origin)) + t);
        faces.clear();
        in.accel->list_crossings(rays, i, see_through, faces);
        std::erase_if(faces, [&](const Crossing& face) { return std::fabs(face.t - t) > near; });
        if (is_one_boundary(faces)) continue;
        work.shadows.r[i] = work.shadows.g[i] = work.shadows.b[i] = 0;
    }
}

/// Stage 4 for shadow rays that wait at thin walls: they need the nearest hit, one thin
/// wall after the other.
void cross_thin_walls(
    const WavefrontInput& in, int count, uint32_t segment, Workspace& work, WavefrontCounters& c) {
    const bool raycast = in.kind == WavefrontKind::raycast;
    const float* time = slot_times(in, work);
    const ThinWallColumns columns{.shadows = work.shadows,
                                  .hits = work.random_walk_hits,
                                  .samples = work.samples,
                                  .time = time,
                                  .shadow_media = shadow_media(in, work)};
    int waiting = in.stages->take_waiting(count, work.occluded.data(), work.shadows);
    for (uint32_t number = 0; waiting > 0 && number <= max_thin_walls; ++number) {
        RayColumns rays = rays_of(work.shadows, waiting);
        if (raycast) rays.key = nullptr;
        rays.time = times_of(in, work.shadows.slot, waiting, work);
        count_rays(in, work.shadows.slot, waiting, work);
        const SeeThrough see_through{.fixed_alpha = raycast,
                                     .segment = segment,
                                     .passes = shadow_rays_pass,
                                     .cutaway = cut_away(work.shadows.slot, work)};
        c.shadow_rays += static_cast<uint64_t>(waiting);
        {
            const SumOfTime timing(c.seconds.shadow);
            c.refused_rays += static_cast<uint64_t>(in.accel->intersect(
                rays, work.random_walk_hits, Coherence::incoherent, see_through));
        }
        if (in.recorder != nullptr) in.recorder->add_shadow_hits(rays, columns.hits, see_through);
        end_at_shared_faces(in, rays, see_through, work);
        const SumOfTime timing(c.seconds.shade);
        const ThinWallStep step{.segment = segment, .number = number, .random = !raycast};
        absorb_up_to_hits(in, waiting, work);
        add_crossed_light_paths(in, waiting, work);
        waiting = in.stages->cross_thin_walls(in.scene, step, waiting, columns);
        move_crossing_shadows(in, waiting, work);
    }
}

/// Marks the shadow rays that reached their light but met possible thin walls.
void keep_waiting(int count, Workspace& work) {
    for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
        if (work.thin_walls[i] != 0 && work.occluded[i] == 0) work.occluded[i] = waits_at_thin_wall;
    }
}

/// Stage 4, and adds its light to the samples.
void trace_segment(
    const WavefrontInput& in, int count, uint32_t segment, Workspace& work, WavefrontCounters& c) {
    const bool passes_thin_walls = in.scene.thin_walls && in.kind != WavefrontKind::ao;
    RayColumns rays = rays_of(work.shadows, count);
    if (in.kind == WavefrontKind::raycast) rays.key = nullptr;
    rays.time = times_of(in, work.shadows.slot, count, work);
    count_rays(in, work.shadows.slot, count, work);
    c.shadow_rays += static_cast<uint64_t>(count);
    if (passes_thin_walls) work.thin_walls.assign(padded_batch_size, 0);
    const ShadowQuery query{.segment = segment,
                            .thin_walls = passes_thin_walls ? work.thin_walls.data() : nullptr,
                            .cutaway = cut_away(work.shadows.slot, work),
                            .passes = shadow_rays_pass};
    {
        const SumOfTime time(c.seconds.shadow);
        c.refused_rays += static_cast<uint64_t>(
            in.accel->occluded(rays, work.occluded.data(), Coherence::incoherent, query));
    }
    if (in.recorder != nullptr) {
        in.recorder->add_shadows(rays, work.occluded.data(), query);
    }
    if (passes_thin_walls) keep_waiting(count, work);
    if (in.accel->has_splats() && in.kind != WavefrontKind::ao) dim_shadows(in, rays, work, c);
    {
        const SumOfTime time(c.seconds.accumulate);
        absorb_unhindered(in, count, work);
        in.stages->add_shadows(count, work.shadows, work.occluded.data(), work.samples);
        add_shadow_light_paths(in, count, work);
    }
    if (passes_thin_walls) cross_thin_walls(in, count, segment, work, c);
}

}  // namespace

void trace_shadows(
    const WavefrontInput& in, int count, int bounce, Workspace& work, WavefrontCounters& c) {
    begin_shadow_light(in, count, bounce, work);
    trace_segment(in, count, 2U * static_cast<uint32_t>(bounce) + 1U, work, c);
}

void trace_walk_shadows(const WavefrontInput& in,
                        int count,
                        const Flight& flight,
                        Workspace& work,
                        WavefrontCounters& c) {
    // A segment of its own for every flight, beyond those of bounces.
    const auto segment = 2U * static_cast<uint32_t>(flight.bounce) + 1U +
                         (static_cast<uint32_t>(flight.number) + 1U) * 0x10000U;
    trace_segment(in, count, segment, work, c);
}

}  // namespace obscura
