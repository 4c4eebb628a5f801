// stages/wavefront.cpp - the wavefront loop: the only place that calls stages.
// SPDX-License-Identifier: Apache-2.0
#include "stages/wavefront.h"

#include "base/stopwatch.h"
#include "stages/shared_faces.h"
#include "stages/wavefront_aov.h"
#include "stages/wavefront_catchers.h"
#include "stages/wavefront_light_paths.h"
#include "stages/wavefront_shadows.h"
#include "stages/wavefront_slots.h"
#include "stages/wavefront_splats.h"
#include "stages/wavefront_visibility.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace obscura {

namespace {

/// Visibility flags of the surfaces that the rays of a path segment pass.
uint8_t passed_by_segment(uint32_t segment) {
    return segment == 0 ? camera_rays_pass : bounce_rays_pass;
}

/// Stage 2: finds the hits of rays.
void intersect_rays(const WavefrontInput& in,
                    const RayColumns& rays,
                    const HitColumns& hits,
                    SeeThrough see_through,
                    WavefrontCounters& c) {
    const bool camera = see_through.segment == 0;
    see_through.passes = passed_by_segment(see_through.segment);
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

/// Records by sample index the back faces that camera rays passed, and from where. Before shading,
/// path i belongs to sample i.
void note_passed_backs(const WavefrontInput& in, Workspace& work) {
    const PathColumns& p = work.paths[0];
    const bool parallel = in.batch.camera.model == CameraModel::orthographic;
    for (const PassedBack& back : work.passed_backs) {
        const auto i = static_cast<size_t>(back.index);
        if (parallel) {
            work.cut_faces[i] = {back.surface, {-p.dx[i], -p.dy[i], -p.dz[i], 0.0f}};
        } else {
            work.cut_faces[i] = {back.surface, {p.ox[i], p.oy[i], p.oz[i], 1.0f}};
        }
    }
}

void forget_passed_backs(Workspace& work) {
    for (const PassedBack& back : work.passed_backs)
        work.cut_faces[static_cast<size_t>(back.index)] = {};
    work.passed_backs.clear();
}

/// Stage 2 for the paths of this bounce.
void intersect(const WavefrontInput& in,
               int count,
               SeeThrough see_through,
               Workspace& work,
               WavefrontCounters& c) {
    RayColumns rays = rays_of(work.paths[0], count);
    if (see_through.segment == 0 && limits_rays(in.batch.camera)) {
        rays.tfar = work.camera_length_m.data();
    }
    // Rays of AOVs have no sample index: ray i belongs to pixel i.
    if (in.kind == WavefrontKind::aov || in.kind == WavefrontKind::wireframe) {
        rays.time = slot_times(in, work);
    } else {
        rays.time = times_of(in, work.paths[0].slot, count, work);
        count_rays(in, work.paths[0].slot, count, work);
    }
    intersect_rays(in, rays, work.hits, see_through, c);
}

/// Camera rays: their hits, the back faces that they passed, and AOVs.
void intersect_camera_rays(const WavefrontInput& in,
                           int count,
                           SeeThrough see_through,
                           Workspace& work,
                           WavefrontCounters& c) {
    see_through.culls_back_faces = true;
    see_through.passed_backs = &work.passed_backs;
    intersect(in, count, see_through, work, c);
    note_passed_backs(in, work);
    if (in.visibility != nullptr || in.catchers.any() || looks_through_glass(in))
        part_camera_hits(in, count, work);
    if (in.aovs.empty()) return;
    work.allot_aovs(in.aovs);
    write_aovs(in, count, work.aov_outputs, work, c);
}

const LightPathColumns* light_path_columns(const WavefrontInput& in, const Workspace& work) {
    return in.light_paths != nullptr ? &work.light_paths.columns() : nullptr;
}

ScatterColumns scatter_columns(const WavefrontInput& in, Workspace& work) {
    return {.paths = work.paths[0],
            .hits = work.hits,
            .random_walks = work.paths[1],
            .random_walk_hits = work.random_walk_hits,
            .path_index = work.random_walk_path.data(),
            .shadows = work.shadows,
            .shadow_media = shadow_media(in, work),
            .time = slot_times(in, work),
            .light_paths = light_path_columns(in, work),
            .lit_points = lit_points(in, work)};
}

/// Whether random walks sample lights: out of media like air, and in the one around the camera.
bool walks_sample_lights(const WavefrontInput& in) {
    const bool from_camera = (in.batch.medium_stack & 0xFFFFFFU) != 0;
    return in.scene.lights.count > 0 && (in.scene.passable_media || from_camera);
}

/// After the first flight: these paths have begun a random walk. Where they sample lights, what
/// samples keep of the last surface ends.
void begin_random_walks(const WavefrontInput& in, int count, bool sample, Workspace& work) {
    move_random_walks(in, count, work);
    if (looks_through_glass(in)) {  // the paths that they return to: walks give no marks back
        for (int i = 0; i < count; ++i)
            work.paths[0].medium_stack[work.random_walk_path[static_cast<size_t>(i)]] |=
                seen_unclearly;
    }
    if (!sample) return;
    for (int i = 0; i < count; ++i) {
        const uint32_t slot = work.paths[1].slot[i];
        if (in.scene.thin_walls) work.distance_since_scattering[slot] = 0;
        if (in.scene.occludes) work.occlusion[slot] = 1;
    }
}

/// Stage 2 inside scattering media: a random walk from scattering to scattering until the path
/// reaches a surface. However many flights it takes, it counts as one bounce.
void scatter_in_media(
    const WavefrontInput& in, int count, int bounce, Workspace& work, WavefrontCounters& c) {
    constexpr int max_flights = 4096;
    const ScatterStart start{.paths = work.paths[0],
                             .hits = work.hits,
                             .random_walks = work.paths[1],
                             .random_walk_hits = work.random_walk_hits,
                             .path_index = work.random_walk_path.data()};
    const ScatterColumns columns = scatter_columns(in, work);
    SeeThrough see_through{.segment = 2U * static_cast<uint32_t>(bounce)};
    ScatterCounts out;
    {
        const SumOfTime time(c.seconds.shade);
        out.random_walks = in.stages->begin_scatter(in.scene, count, start);
    }
    Flight flight{.bounce = bounce, .samples_lights = walks_sample_lights(in)};
    for (; out.random_walks > 0; ++flight.number) {
        {
            const SumOfTime time(c.seconds.shade);
            flight.last = flight.number + 1 == max_flights;
            out = in.stages->scatter(in.scene, in.batch, flight, out.random_walks, columns);
        }
        if (out.shadow > 0) begin_walk_shadow_light(in, out.shadow, flight, work);
        if (flight.number == 0)
            begin_random_walks(in, out.random_walks, flight.samples_lights, work);
        if (out.shadow > 0) trace_walk_shadows(in, out.shadow, flight, work, c);
        if (out.random_walks == 0) return;
        RayColumns rays = rays_of(columns.random_walks, out.random_walks);
        rays.time = times_of(in, columns.random_walks.slot, out.random_walks, work);
        count_rays(in, columns.random_walks.slot, out.random_walks, work);
        see_through.cutaway = cut_away(columns.random_walks.slot, work);
        intersect_rays(in, rays, work.random_walk_hits, see_through, c);
    }
}

/// Stage 2, where media touch and their faces may coincide. The second search starts from the face
/// to shade, so that the result does not depend on which face Embree reported.
void cross_shared_faces(const WavefrontInput& in,
                        int count,
                        SeeThrough see_through,
                        Workspace& work) {
    const float* time = slot_times(in, work);
    see_through.passed_backs = nullptr;
    see_through.passes = passed_by_segment(see_through.segment);
    work.shared_faces.assign(padded_batch_size, {});
    SharedFaces* const found = work.shared_faces.data();
    for (const SharedFaces* only :
         {static_cast<const SharedFaces*>(nullptr), static_cast<const SharedFaces*>(found)}) {
        const ProbeColumns columns{.paths = work.paths[0],
                                   .hits = work.hits,
                                   .time = time,
                                   .shared = only,
                                   .probes = work.shadows,
                                   .path_index = work.random_walk_path.data()};
        const int probes = in.stages->make_probes(in.scene, count, columns);
        const CoincidenceQuery query{.accel = *in.accel,
                                     .touching_media = in.scene.touching_media,
                                     .see_through = see_through};
        if (resolve_coincident_faces(query, probes, columns, work.hits, found) == 0) return;
    }
}

ShadeColumns shade_columns(const WavefrontInput& in, Workspace& work) {
    return {.paths = work.paths[0],
            .hits = work.hits,
            .misses = work.misses,
            .next = work.paths[1],
            .shadows = work.shadows,
            .samples = work.samples,
            .time = slot_times(in, work),
            .distance_since_scattering =
                in.scene.thin_walls ? work.distance_since_scattering.data() : nullptr,
            .occlusion = in.scene.occludes ? work.occlusion.data() : nullptr,
            .shared = work.shared_faces.empty() ? nullptr : work.shared_faces.data(),
            .light_paths = light_path_columns(in, work),
            .shadow_media = shadow_media(in, work),
            .lit_points = lit_points(in, work)};
}

RaycastColumns raycast_columns(const WavefrontInput& in, Workspace& work) {
    return {.paths = work.paths[0],
            .hits = work.hits,
            .shadows = work.shadows,
            .samples = work.samples,
            .time = slot_times(in, work),
            .shared = work.shared_faces.empty() ? nullptr : work.shared_faces.data()};
}

/// Shades the catchers that paths met at a bounce; returns the number of paths with theirs.
int add_catcher_paths(
    const WavefrontInput& in, int bounce, int count, Workspace& work, WavefrontCounters& c) {
    const CatcherWork& catcher = work.catcher;
    if (static_cast<size_t>(catcher.first) == catcher.samples.size()) return count;
    const CatcherCounts out = leave_catchers(in, bounce, count, work);
    WavefrontInput own = in;
    own.light_paths = nullptr;  // what a catcher receives is no share of the light
    if (out.shadow > 0) trace_shadows(own, out.shadow, bounce, work, c);
    return out.next;
}

/// Traces the paths in work.paths[0] from a bounce to their ends.
void follow_paths(
    const WavefrontInput& in, int count, int first_bounce, Workspace& work, WavefrontCounters& c) {
    // One more segment than there are bounces: the last one only collects emitted light. It passes
    // thin walls, as the shadow rays of the last bounce do.
    const int segments = in.batch.max_bounces + 2 + (in.scene.thin_walls ? max_thin_walls : 0);
    for (int bounce = first_bounce; count > 0 && bounce < segments; ++bounce) {
        SeeThrough see_through{.segment = 2U * static_cast<uint32_t>(bounce)};
        if (bounce == 0) {
            intersect_camera_rays(in, count, see_through, work, c);
        } else {
            see_through.cutaway = cut_away(work.paths[0].slot, work);
            intersect(in, count, see_through, work, c);
        }
        if (in.scene.scatters) scatter_in_media(in, count, bounce, work, c);
        if (in.scene.touching_media != nullptr) cross_shared_faces(in, count, see_through, work);
        if (in.accel->has_splats()) pass_splats(in, count, bounce, work, c);
        const bool through_glass = bounce > 0 && looks_through_glass(in);
        if (through_glass) look_through_glass(in, bounce, count, work, c);
        if (bounce > 0 && work.looking_for_albedo > 0) look_for_albedo(in, count, bounce, work, c);
        if (through_glass) end_behind_glass(work);
        if (in.light_paths != nullptr) work.light_paths.begin_bounce();
        if (bounce > 0 && in.visibility != nullptr)
            add_light_behind({in, bounce, shade_columns(in, work)}, count, work, c);
        ShadeCounts out;
        {
            const SumOfTime time(c.seconds.shade);
            out = in.stages->shade(in.scene, in.batch, bounce, count, shade_columns(in, work));
        }
        if (out.shadow > 0) {
            split_straight_shadows(in, out.next, work);
            trace_shadows(in, out.shadow, bounce, work, c);
        }
        move_straight_paths(in, out.next, work);
        std::swap(work.paths[0], work.paths[1]);
        count = out.next;
        if (in.catchers.any()) count = add_catcher_paths(in, bounce, count, work, c);
    }
}

/// Traces what shadow catchers reflect; of that, other surfaces are shown alone.
void follow_reflections(const WavefrontInput& in, Workspace& work, WavefrontCounters& c) {
    for (const CatcherReflections& reflections : work.catcher.reflected) {
        const int bounce = reflections.bounce + 1;
        take_reflections(reflections, work);
        work.clear_slots(in.scene);
        SeeThrough see_through{.segment = 2U * static_cast<uint32_t>(bounce)};
        see_through.cutaway = cut_away(work.paths[0].slot, work);
        intersect(in, reflections.count, see_through, work, c);
        follow_paths(in, keep_hits(reflections.count, work), bounce, work, c);
    }
}

void trace_paths(const WavefrontInput& in, int count, Workspace& work, WavefrontCounters& c) {
    work.clear_slots(in.scene);
    begin_light_paths(in, count, work);
    follow_paths(in, count, 0, work, c);
    if (in.catchers.any()) {
        c.nonfinite_samples += settle_catchers(work);
        release_catchers(in, work);
        follow_reflections(in, work, c);
    }
    finish_light_paths(in, work);
}

void trace_ao(const WavefrontInput& in, int count, Workspace& work, WavefrontCounters& c) {
    intersect_camera_rays(in, count, {}, work, c);
    int shadows = 0;
    {
        const SumOfTime time(c.seconds.shade);
        shadows = spawn_ambient_rays(in, count, work);
    }
    if (shadows > 0) trace_shadows(in, shadows, 0, work, c);
}

/// Pairs hits with lights in as many steps as the shadow columns need. The lights of a sample are
/// added in the same order however the steps are cut.
void trace_raycast(const WavefrontInput& in, int count, Workspace& work, WavefrontCounters& c) {
    const int max_lights = in.notes != nullptr ? 1 : batch_size / 16;
    intersect_camera_rays(in, count, {.fixed_alpha = true}, work, c);
    if (in.accel->has_splats()) pass_splats(in, count, 0, work, c);
    int hits = 0;
    {
        if (in.notes != nullptr) in.notes->add_ray(work.paths[0], work.hits);
        const SumOfTime time(c.seconds.shade);
        hits = in.stages->begin_raycast(in.scene, in.batch, count, shade_columns(in, work));
    }
    const RaycastColumns columns = raycast_columns(in, work);
    const int lights = in.scene.lights.punctual_count + in.scene.raycast.centre_count;
    RaycastRange range;
    for (range.first_light = 0; range.first_light == 0 || range.first_light < lights;
         range.first_light += max_lights) {
        range.lights = std::min(lights - range.first_light, max_lights);
        const int max_hits = batch_size / std::max(range.lights, 1) / 16 * 16;
        for (range.first_hit = 0; range.first_hit < hits; range.first_hit += max_hits) {
            range.hits = std::min(hits - range.first_hit, max_hits);
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

/// Adds up the wireframe of every ray of the grid; see wireframe_side.
void trace_wireframe(
    const WavefrontInput& in, int pixels, Workspace& work, PixelSum* sums, WavefrontCounters& c) {
    WavefrontInput one = in;
    for (int i = 0; i < in.batch.samples; ++i) {
        const int ray = static_cast<int>(in.batch.first_sample) + i;
        const auto offset = [](int cell) {
            return (static_cast<float>(cell) + 0.5f) / wireframe_side - 0.5f;
        };
        one.batch.film_offset_px[0] = offset(ray % wireframe_side);
        one.batch.film_offset_px[1] = offset(ray / wireframe_side);
        trace_aov(one, pixels, work, c);
        const SumOfTime time(c.seconds.accumulate);
        in.stages->accumulate(pixels, {static_cast<uint32_t>(ray), 1}, work.samples, sums);
    }
}

float* camera_lengths(const WavefrontInput& in, Workspace& work) {
    return limits_rays(in.batch.camera) ? work.camera_length_m.data() : nullptr;
}

/// Writes the counts of Accel::count_tests as samples.
void count_heat(const WavefrontInput& in, int pixels, Workspace& work, WavefrontCounters& c) {
    RayColumns rays = rays_of(work.paths[0], pixels);
    rays.tfar = camera_lengths(in, work);
    c.camera_rays += static_cast<uint64_t>(pixels);
    const SumOfTime time(c.seconds.intersect_camera);
    c.refused_rays += static_cast<uint64_t>(in.counting->count_tests(rays, work.samples.r));
}

}  // namespace

int spawn_ambient_rays(const WavefrontInput& in, int count, Workspace& work) {
    return in.stages->shade_ao(in.scene, in.batch, count, shade_columns(in, work));
}

void trace_batch(const WavefrontInput& in,
                 int pixels,
                 Workspace& work,
                 PixelSum* sums,
                 WavefrontCounters& counters) {
    if (in.kind == WavefrontKind::wireframe)
        return trace_wireframe(in, pixels, work, sums, counters);
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
    if (in.counts_rays) work.rays_cast.assign(padded_batch_size, 0);
    switch (in.kind) {
        case WavefrontKind::path:
            trace_paths(in, count, work, counters);
            break;
        case WavefrontKind::ao:
            trace_ao(in, count, work, counters);
            break;
        case WavefrontKind::raycast:
            trace_raycast(in, count, work, counters);
            break;
        case WavefrontKind::wireframe:
        case WavefrontKind::aov:
        case WavefrontKind::heat:
            break;
    }
    const SumOfTime time(counters.seconds.accumulate);
    counters.nonfinite_samples += in.stages->accumulate(
        pixels, {in.batch.first_sample, in.batch.samples}, work.samples, sums);
}

void trace_aov(const WavefrontInput& in, int pixels, Workspace& work, WavefrontCounters& counters) {
    {
        const SumOfTime time(counters.seconds.camera);
        in.stages->centre_camera(in.batch, pixels, work.paths[0], camera_lengths(in, work));
        if (moves(in.scene.motion)) {
            in.stages->open_shutter(in.scene, true, pixels, work.paths[0], work.slot_time.data());
        }
    }
    counters.paths += static_cast<uint64_t>(pixels);
    if (in.kind == WavefrontKind::heat) return count_heat(in, pixels, work, counters);
    intersect(in, pixels, {.culls_back_faces = true, .fixed_alpha = true}, work, counters);
    if (in.visibility != nullptr) part_camera_hits(in, pixels, work);
    if (in.kind == WavefrontKind::wireframe) {
        const SumOfTime time(counters.seconds.shade);
        in.stages->wireframe(in.scene,
                             in.batch,
                             pixels,
                             {.paths = work.paths[0],
                              .hits = work.hits,
                              .samples = work.samples,
                              .time = slot_times(in, work)});
    } else {
        write_aovs(in, pixels, aovs_in_samples(in.aovs, work), work, counters);
    }
    counters.nonfinite_samples += in.stages->clear_nonfinite(pixels, work.samples);
}

}  // namespace obscura
