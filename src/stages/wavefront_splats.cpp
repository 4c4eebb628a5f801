// stages/wavefront_splats.cpp - Gaussian splats along path segments and shadow rays.
// SPDX-License-Identifier: Apache-2.0
#include "stages/wavefront_splats.h"

#include "base/stopwatch.h"
#include "stages/contribution_limit.h"

namespace obscura {

namespace {

/// Distances to the hits, or to the ends of rays that hit nothing.
const float* path_ends(const WavefrontInput& in, int count, bool camera, Workspace& work) {
    const bool limited = camera && limits_rays(in.batch.camera);
    for (int i = 0; i < count; ++i) {
        const auto index = static_cast<size_t>(i);
        const float farthest = limited ? work.camera_length_m[index] : unlimited;
        work.ray_end[index] = work.hits.primitive[i] >= 0 ? work.hits.t[i] : farthest;
    }
    return work.ray_end.data();
}

/// Adds the splats' part to the alpha of a camera sample; set_camera_alpha will add the part behind
/// the splats, the background or an opaque hit. Must run before the paths are dimmed.
void cover_sample(const WavefrontInput& in, int index, float transmittance, Workspace& work) {
    const SampleColumns& samples = work.samples;
    const uint32_t slot = work.paths[0].slot[index];
    const bool hit = work.hits.primitive[index] >= 0;
    const float* background = in.batch.background;
    const float behind = hit ? 1.0f : background[3];
    const float held = 1.0f - transmittance;
    // Without light from behind, the path counts as outside the camera's image.
    const float added = transmittance > 0 ? behind : 0.0f;
    samples.a[slot] += 1.0f - transmittance * (1.0f - behind) - added;
    if (hit || transmittance == 0) return;
    const Vec3f hidden{held * background[0], held * background[1], held * background[2]};
    samples.r[slot] -= hidden.x;
    samples.g[slot] -= hidden.y;
    samples.b[slot] -= hidden.z;
    if (in.light_paths != nullptr)
        work.light_paths.add_path_light(slot, background_class(*in.light_paths), -hidden);
}

SplatColumns splat_columns_of(Workspace& work) {
    return {
        work.splats[0].data(), work.splats[1].data(), work.splats[2].data(), work.splats[3].data()};
}

}  // namespace

void pass_splats(
    const WavefrontInput& in, int count, int bounce, Workspace& work, WavefrontCounters& c) {
    const bool camera = bounce == 0;
    const float limit = contribution_limit(in.batch, bounce);
    const SumOfTime time(camera ? c.seconds.intersect_camera : c.seconds.intersect_bounce);
    const PathColumns& p = work.paths[0];
    RayColumns rays = rays_of(p, count);
    rays.tfar = path_ends(in, count, camera, work);
    rays.key = nullptr;
    const bool parallel = camera && in.batch.camera.model == CameraModel::orthographic;
    const SplatColumns found = splat_columns_of(work);
    in.accel->blend_splats(rays, parallel, found);
    for (int i = 0; i < count; ++i) {
        const float passes = found.transmittance[i];
        const bool shows = p.tr[i] != 0;  // inside the camera's image
        if (passes == 1.0f || (camera && !shows)) continue;
        const uint32_t slot = p.slot[i];
        const Vec3f light = limit_contribution(
            Vec3f{p.tr[i] * found.r[i], p.tg[i] * found.g[i], p.tb[i] * found.b[i]}, limit);
        work.samples.r[slot] += light.x;
        work.samples.g[slot] += light.y;
        work.samples.b[slot] += light.z;
        if (in.light_paths != nullptr) {
            work.light_paths.add_path_light(slot, ungrouped_emitter_class(*in.light_paths), light);
        }
        if (camera) cover_sample(in, i, passes, work);
        p.tr[i] *= passes;
        p.tg[i] *= passes;
        p.tb[i] *= passes;
        if (passes == 0) work.hits.primitive[i] = -1;
    }
}

void dim_shadows(const WavefrontInput& in,
                 const RayColumns& rays,
                 Workspace& work,
                 WavefrontCounters& counters) {
    const SumOfTime time(counters.seconds.shadow);
    float* passes = splat_columns_of(work).transmittance;
    in.accel->dim_by_splats(rays, work.occluded.data(), passes);
    const ShadowColumns& s = work.shadows;
    for (int i = 0; i < rays.count; ++i) {
        s.r[i] *= passes[i];
        s.g[i] *= passes[i];
        s.b[i] *= passes[i];
    }
}

}  // namespace obscura
