// stages/walk.cpp - the wavefront loop: the only place that calls stages.
// SPDX-License-Identifier: Apache-2.0
#include "stages/walk.h"

#include "base/stopwatch.h"
#include "stages/shared_faces.h"
#include "stages/walk_splats.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace obscura {

namespace {

/// The time of every slot, where something moves.
const float* slot_times(const WalkInput& in, const Workspace& work) {
    return moves(in.scene.motion) ? work.slot_time.data() : nullptr;
}

/// The times of rays, where something moves.
const float* times_of(const WalkInput& in, const uint32_t* slot, int count, Workspace& work) {
    if (!moves(in.scene.motion)) return nullptr;
    for (int i = 0; i < count; ++i)
        work.ray_time[static_cast<size_t>(i)] = work.slot_time[slot[i]];
    return work.ray_time.data();
}

/// Stage 2: what rays hit.
void intersect_rays(const WalkInput& in,
                    const RayColumns& rays,
                    const HitRows& hits,
                    SeeThrough see_through,
                    WalkCounters& c) {
    const bool camera = see_through.segment == 0;
    const int count = rays.count;
    (camera ? c.camera_rays : c.bounce_rays) += static_cast<uint64_t>(count);
    {
        const SumOfTime time(camera ? c.seconds.intersect_camera : c.seconds.intersect_bounce);
        const Coherence coherence = camera ? Coherence::coherent : Coherence::incoherent;
        c.refused_rays +=
            static_cast<uint64_t>(in.accel->intersect(rays, hits, coherence, see_through));
    }
    if (in.recorder != nullptr) in.recorder->add_hits(rays, hits, see_through);
}

/// Notes by slot what the camera's rays looked through, and from where: before they are shaded, row
/// i is slot i.
void note_passed_backs(const WalkInput& in, Workspace& work) {
    const PathRows& p = work.paths[0];
    const bool parallel = in.batch.camera.model == CameraModel::orthographic;
    for (const PassedBack& back : work.passed_backs) {
        const auto i = static_cast<size_t>(back.row);
        if (parallel) {
            work.cut_faces[i] = {back.surface, {-p.dx[i], -p.dy[i], -p.dz[i], 0.0f}};
        } else {
            work.cut_faces[i] = {back.surface, {p.ox[i], p.oy[i], p.oz[i], 1.0f}};
        }
    }
}

void forget_passed_backs(Workspace& work) {
    for (const PassedBack& back : work.passed_backs)
        work.cut_faces[static_cast<size_t>(back.row)] = {};
    work.passed_backs.clear();
}

/// What is cut away for all rays of a path but the first; null: nothing, for any path.
const Cutaway* cut_away(const uint32_t* slot, Workspace& work) {
    if (work.passed_backs.empty()) return nullptr;
    work.cutaway = {work.cut_faces.data(), slot};
    return &work.cutaway;
}

/// Stage 2 for the paths of this bounce.
void intersect(
    const WalkInput& in, int count, SeeThrough see_through, Workspace& work, WalkCounters& c) {
    RayColumns rays = rays_of(work.paths[0], count);
    if (see_through.segment == 0 && limits_rays(in.batch.camera)) {
        rays.tfar = work.camera_length_m.data();
    }
    // Rays of quantities have no slot: row i is pixel i.
    if (in.kind == WalkKind::quantity || in.kind == WalkKind::wireframe) {
        rays.time = slot_times(in, work);
    } else {
        rays.time = times_of(in, work.paths[0].slot, count, work);
    }
    intersect_rays(in, rays, work.hits, see_through, c);
}

/// Stage 2 inside bodies that scatter light: their paths fly from scattering to scattering until
/// they come to a surface. However many flights that takes, it is one bounce.
void scatter_in_bodies(
    const WalkInput& in, int count, int bounce, Workspace& work, WalkCounters& c) {
    constexpr int most_flights = 4096;
    const ScatterStart start{.paths = work.paths[0],
                             .hits = work.hits,
                             .walkers = work.paths[1],
                             .walker_hits = work.walker_hits,
                             .row = work.walker_row.data()};
    const ScatterRows rows{.paths = work.paths[0],
                           .hits = work.hits,
                           .walkers = work.paths[1],
                           .walker_hits = work.walker_hits,
                           .row = work.walker_row.data()};
    SeeThrough see_through{.segment = 2U * static_cast<uint32_t>(bounce)};
    int walkers = 0;
    {
        const SumOfTime time(c.seconds.shade);
        walkers = in.stages->begin_scatter(in.scene, count, start);
    }
    for (int number = 0; walkers > 0; ++number) {
        {
            const SumOfTime time(c.seconds.shade);
            const Flight flight{bounce, number, number + 1 == most_flights};
            walkers = in.stages->scatter(in.scene, flight, walkers, rows);
        }
        if (walkers == 0) return;
        RayColumns rays = rays_of(rows.walkers, walkers);
        rays.time = times_of(in, rows.walkers.slot, walkers, work);
        see_through.cutaway = cut_away(rows.walkers.slot, work);
        intersect_rays(in, rays, work.walker_hits, see_through, c);
    }
}

/// Stage 2, where bodies touch: their faces may lie in the same place. The second look is from the
/// face that counts, so that nothing depends on which of them was met.
void cross_shared_faces(const WalkInput& in, int count, SeeThrough see_through, Workspace& work) {
    const float* time = slot_times(in, work);
    see_through.passed_backs = nullptr;
    work.shared_faces.assign(padded_rows, {});
    SharedFaces* const found = work.shared_faces.data();
    for (const SharedFaces* only :
         {static_cast<const SharedFaces*>(nullptr), static_cast<const SharedFaces*>(found)}) {
        const ProbeRows rows{.paths = work.paths[0],
                             .hits = work.hits,
                             .time = time,
                             .shared = only,
                             .probes = work.shadows,
                             .row = work.walker_row.data()};
        const int probes = in.stages->make_probes(in.scene, count, rows);
        const CompanyQuery query{.accel = *in.accel,
                                 .touching_bodies = in.scene.touching_bodies,
                                 .see_through = see_through};
        if (meet_company(query, probes, rows, work.hits, found) == 0) return;
    }
}

/// Stage 4 for the rays that wait at thin walls: nearest hits, for which wall is met now counts.
void cross_walls(
    const WalkInput& in, int count, uint32_t segment, Workspace& work, WalkCounters& c) {
    const bool raycast = in.kind == WalkKind::raycast;
    const float* time = slot_times(in, work);
    const WallRows rows{
        .shadows = work.shadows, .hits = work.walker_hits, .samples = work.samples, .time = time};
    int waiting = in.stages->take_waiting(count, work.occluded.data(), work.shadows);
    for (uint32_t number = 0; waiting > 0 && number <= most_walls; ++number) {
        RayColumns rays = rays_of(work.shadows, waiting);
        if (raycast) rays.key = nullptr;
        rays.time = times_of(in, work.shadows.slot, waiting, work);
        const SeeThrough see_through{.fixed_alpha = raycast,
                                     .segment = segment,
                                     .cutaway = cut_away(work.shadows.slot, work)};
        c.shadow_rays += static_cast<uint64_t>(waiting);
        {
            const SumOfTime timing(c.seconds.shadow);
            c.refused_rays += static_cast<uint64_t>(
                in.accel->intersect(rays, work.walker_hits, Coherence::incoherent, see_through));
        }
        if (in.recorder != nullptr) in.recorder->add_shadow_hits(rays, rows.hits, see_through);
        const SumOfTime timing(c.seconds.shade);
        const WallStep step{.segment = segment, .number = number, .random = !raycast};
        waiting = in.stages->cross_walls(in.scene, step, waiting, rows);
    }
}

/// Marks the shadow rays that reached their light but met what may be thin walls on the way.
void keep_waiting(int count, Workspace& work) {
    for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
        if (work.walls[i] != 0 && work.occluded[i] == 0) work.occluded[i] = waits_at_wall;
    }
}

/// Stage 4, and its light into the samples.
void trace_shadows(const WalkInput& in, int count, int bounce, Workspace& work, WalkCounters& c) {
    const auto segment = 2U * static_cast<uint32_t>(bounce) + 1U;
    const bool passes_walls = in.scene.thin_walls && in.kind != WalkKind::ao;
    RayColumns rays = rays_of(work.shadows, count);
    if (in.kind == WalkKind::raycast) rays.key = nullptr;
    rays.time = times_of(in, work.shadows.slot, count, work);
    c.shadow_rays += static_cast<uint64_t>(count);
    if (passes_walls) work.walls.assign(padded_rows, 0);
    const ShadowQuery query{.segment = segment,
                            .walls = passes_walls ? work.walls.data() : nullptr,
                            .cutaway = cut_away(work.shadows.slot, work)};
    {
        const SumOfTime time(c.seconds.shadow);
        c.refused_rays += static_cast<uint64_t>(
            in.accel->occluded(rays, work.occluded.data(), Coherence::incoherent, query));
    }
    if (in.recorder != nullptr) {
        in.recorder->add_shadows(rays, work.occluded.data(), query);
    }
    if (passes_walls) keep_waiting(count, work);
    if (in.accel->has_splats() && in.kind != WalkKind::ao) dim_shadows(in, rays, work, c);
    {
        const SumOfTime time(c.seconds.accumulate);
        in.stages->add_shadows(count, work.shadows, work.occluded.data(), work.samples);
    }
    if (passes_walls) cross_walls(in, count, segment, work, c);
}

ShadeRows shade_rows(const WalkInput& in, Workspace& work) {
    return {.paths = work.paths[0],
            .hits = work.hits,
            .misses = work.misses,
            .next = work.paths[1],
            .shadows = work.shadows,
            .samples = work.samples,
            .time = slot_times(in, work),
            .passed = in.scene.thin_walls ? work.passed.data() : nullptr,
            .occlusion = in.scene.occludes ? work.occlusion.data() : nullptr,
            .shared = work.shared_faces.empty() ? nullptr : work.shared_faces.data()};
}

RaycastColumns raycast_columns(const WalkInput& in, Workspace& work) {
    return {.paths = work.paths[0],
            .hits = work.hits,
            .shadows = work.shadows,
            .samples = work.samples,
            .time = slot_times(in, work),
            .shared = work.shared_faces.empty() ? nullptr : work.shared_faces.data()};
}

void walk_paths(const WalkInput& in, int count, Workspace& work, WalkCounters& c) {
    // One more segment than there are bounces: the last one only collects emitted light. It goes on
    // through thin walls, as the shadow rays of the last bounce do.
    const int segments = in.batch.max_bounces + 2 + (in.scene.thin_walls ? most_walls : 0);
    work.clear_slots(in.scene);
    for (int bounce = 0; count > 0 && bounce < segments; ++bounce) {
        SeeThrough see_through{.culls_back_faces = bounce == 0,
                               .segment = 2U * static_cast<uint32_t>(bounce)};
        if (bounce == 0) see_through.passed_backs = &work.passed_backs;
        if (bounce > 0) see_through.cutaway = cut_away(work.paths[0].slot, work);
        intersect(in, count, see_through, work, c);
        if (bounce == 0) note_passed_backs(in, work);
        if (in.scene.scatters) scatter_in_bodies(in, count, bounce, work, c);
        if (in.scene.touching_bodies != nullptr) cross_shared_faces(in, count, see_through, work);
        if (in.accel->has_splats()) pass_splats(in, count, bounce == 0, work, c);
        ShadeCounts out;
        {
            const SumOfTime time(c.seconds.shade);
            out = in.stages->shade(in.scene, in.batch, bounce, count, shade_rows(in, work));
        }
        if (out.shadow > 0) trace_shadows(in, out.shadow, bounce, work, c);
        std::swap(work.paths[0], work.paths[1]);
        count = out.next;
    }
}

void walk_ao(const WalkInput& in, int count, Workspace& work, WalkCounters& c) {
    const SeeThrough see_through{.culls_back_faces = true, .passed_backs = &work.passed_backs};
    intersect(in, count, see_through, work, c);
    note_passed_backs(in, work);
    int shadows = 0;
    {
        const SumOfTime time(c.seconds.shade);
        shadows = spawn_ambient_rays(in, count, work);
    }
    if (shadows > 0) trace_shadows(in, shadows, 0, work, c);
}

/// Hits and lights are joined in as many steps as the shadow columns need; for a sample the lights
/// come in the same order however they are cut.
void walk_raycast(const WalkInput& in, int count, Workspace& work, WalkCounters& c) {
    const int most_lights = in.notes != nullptr ? 1 : batch_rows / 16;
    const SeeThrough see_through{
        .culls_back_faces = true, .fixed_alpha = true, .passed_backs = &work.passed_backs};
    intersect(in, count, see_through, work, c);
    note_passed_backs(in, work);
    if (in.accel->has_splats()) pass_splats(in, count, true, work, c);
    int hits = 0;
    {
        if (in.notes != nullptr) in.notes->add_ray(work.paths[0], work.hits);
        const SumOfTime time(c.seconds.shade);
        hits = in.stages->begin_raycast(in.scene, in.batch, count, shade_rows(in, work));
    }
    const RaycastColumns columns = raycast_columns(in, work);
    const int lights = in.scene.lights.punctual_count + in.scene.raycast.centre_count;
    RaycastRange range;
    for (range.first_light = 0; range.first_light == 0 || range.first_light < lights;
         range.first_light += most_lights) {
        range.lights = std::min(lights - range.first_light, most_lights);
        const int most_hits = batch_rows / std::max(range.lights, 1) / 16 * 16;
        for (range.first_hit = 0; range.first_hit < hits; range.first_hit += most_hits) {
            range.hits = std::min(hits - range.first_hit, most_hits);
            int shadows = 0;
            {
                const SumOfTime time(c.seconds.shade);
                shadows = in.stages->shade_raycast(in.scene, range, columns);
            }
            if (in.notes != nullptr) in.notes->add_offer(range, shadows, columns);
            if (shadows > 0) trace_shadows(in, shadows, 0, work, c);
            if (in.notes != nullptr) in.notes->add_arrival(work.occluded[0], columns);
        }
    }
}

/// One quantity a ray of the grid, added up; see wireframe_side.
void walk_wireframe(
    const WalkInput& in, int pixels, Workspace& work, PixelSum* sums, WalkCounters& c) {
    WalkInput one = in;
    for (int i = 0; i < in.batch.samples; ++i) {
        const int ray = static_cast<int>(in.batch.first_sample) + i;
        const auto offset = [](int place) {
            return (static_cast<float>(place) + 0.5f) / wireframe_side - 0.5f;
        };
        one.batch.film_offset_px[0] = offset(ray % wireframe_side);
        one.batch.film_offset_px[1] = offset(ray / wireframe_side);
        walk_quantity(one, pixels, work, c);
        const SumOfTime time(c.seconds.accumulate);
        in.stages->accumulate(pixels, {static_cast<uint32_t>(ray), 1}, work.samples, sums);
    }
}

float* camera_lengths(const WalkInput& in, Workspace& work) {
    return limits_rays(in.batch.camera) ? work.camera_length_m.data() : nullptr;
}

/// What Accel::count_tests says, as samples.
void count_heat(const WalkInput& in, int pixels, Workspace& work, WalkCounters& c) {
    RayColumns rays = rays_of(work.paths[0], pixels);
    rays.tfar = camera_lengths(in, work);
    c.camera_rays += static_cast<uint64_t>(pixels);
    const SumOfTime time(c.seconds.intersect_camera);
    c.refused_rays += static_cast<uint64_t>(in.counting->count_tests(rays, work.samples.r));
}

}  // namespace

int spawn_ambient_rays(const WalkInput& in, int count, Workspace& work) {
    return in.stages->shade_ao(in.scene, in.batch, count, shade_rows(in, work));
}

void walk(
    const WalkInput& in, int pixels, Workspace& work, PixelSum* sums, WalkCounters& counters) {
    if (in.kind == WalkKind::wireframe) return walk_wireframe(in, pixels, work, sums, counters);
    const int count = pixels * in.batch.samples;
    {
        const SumOfTime time(counters.seconds.camera);
        float* length_m = camera_lengths(in, work);
        in.stages->camera(in.batch, count, work.paths[0], work.samples, length_m);
        if (moves(in.scene.motion)) {
            const bool centres = in.batch.through_centres;
            in.stages->open_shutter(in.scene, centres, count, work.paths[0], work.slot_time.data());
        }
    }
    counters.paths += static_cast<uint64_t>(count);
    forget_passed_backs(work);
    switch (in.kind) {
        case WalkKind::path:
            walk_paths(in, count, work, counters);
            break;
        case WalkKind::ao:
            walk_ao(in, count, work, counters);
            break;
        case WalkKind::raycast:
            walk_raycast(in, count, work, counters);
            break;
        case WalkKind::wireframe:
        case WalkKind::quantity:
            break;
    }
    const SumOfTime time(counters.seconds.accumulate);
    counters.nonfinite_samples += in.stages->accumulate(
        pixels, {in.batch.first_sample, in.batch.samples}, work.samples, sums);
}

void walk_quantity(const WalkInput& in, int pixels, Workspace& work, WalkCounters& counters) {
    {
        const SumOfTime time(counters.seconds.camera);
        in.stages->centre_camera(in.batch, pixels, work.paths[0], camera_lengths(in, work));
        if (moves(in.scene.motion)) {
            in.stages->open_shutter(in.scene, true, pixels, work.paths[0], work.slot_time.data());
        }
    }
    counters.paths += static_cast<uint64_t>(pixels);
    if (in.quantity == Quantity::heat) return count_heat(in, pixels, work, counters);
    intersect(in, pixels, {.culls_back_faces = true, .fixed_alpha = true}, work, counters);
    const SumOfTime time(counters.seconds.shade);
    in.stages->quantity(in.scene,
                        in.batch,
                        in.quantity,
                        pixels,
                        {.paths = work.paths[0],
                         .hits = work.hits,
                         .samples = work.samples,
                         .time = slot_times(in, work)});
    counters.nonfinite_samples += in.stages->clear_nonfinite(pixels, work.samples);
}

}  // namespace obscura
