// stages/3_misses.h - environment light for paths that leave the scene; alpha of camera rays.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/sampler.h"
#include "stages/3_light_paths.h"
#include "stages/3_lights.h"
#include "stages/3_shade.h"
#include "stages/contribution_limit.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Environment light of camera rays that left the scene.
inline void add_background(const EnvironmentView& environment,
                           int count_in,
                           const ShadeColumns& columns) {
    const MissView m = columns.misses;
    for (int i = 0; i < count_in; i += lane_count) {
        const Mask exists = lanes_in_range(i, count_in);
        const Vec3<Lanes> direction =
            select(exists, load3(m.dx, m.dy, m.dz, i), splat3(Lanes(0.57735f)));
        const Vec3<Lanes> light = environment_radiance(environment, direction);
        const LanesU slot = load(m.slot + i);
        const Vec3<Lanes> seen = light * load3(m.tr, m.tg, m.tb, i);
        add_radiance(columns.samples, exists, slot, seen);
        if (columns.light_paths != nullptr)
            add_background_light(*columns.light_paths, exists, slot, seen);
    }
}

/// Weight of environment light along a ray that the BSDF chose with density `pdf`, where light
/// sampling has the density `other`; 1 where only one of the two could find it.
OBSCURA_INLINE Lanes environment_weight(int strategies, Lanes pdf, Lanes other) {
    if (strategies == sample_bsdfs) return Lanes(1.0f);
    const Mask both_can = (pdf > Lanes(0.0f)) & (other > Lanes(0.0f));
    const Lanes weight = strategies == sample_lights ? Lanes(0.0f) : mis_weight(pdf, other);
    return select(both_can, weight, Lanes(1.0f));
}

/// The environment pixel that a bounced ray meets; already prefetched.
struct MetPixel {
    LanesI word;
    Lanes sin_theta;
};

OBSCURA_INLINE MetPixel
meet_pixel(const EnvironmentView& environment, const MissView& m, int i, Mask exists, int bounce) {
    const Vec3<Lanes> direction =
        select(exists, load3(m.dx, m.dy, m.dz, i), splat3(Lanes(0.57735f)));
    const EnvironmentCell<Lanes> cell = environment_cell(environment, direction);
    const LanesU random =
        hash_word(load(m.path_key + i) + LanesU(static_cast<uint32_t>(bounce) * 0x9E3779B9U));
    const MetPixel met{choose_environment_pixel(cell, random), cell.sin_theta};
    prefetch<Lanes>(environment.pixels, met.word);
    return met;
}

/// Environment light of the paths that left the scene.
inline void shade_misses(const SceneView& scene,
                         const BatchSettings& batch,
                         int bounce,
                         int count_in,
                         const ShadeColumns& columns) {
    const EnvironmentView& environment = scene.environment;
    const MissView m = columns.misses;
    if (!scene.has_environment) return;
    if (bounce == 0) {
        if (batch.background_visible) add_background(environment, count_in, columns);
        return;
    }
    const float limit = contribution_limit(batch, bounce);
    MetPixel met[groups_ahead];
    for (int first = 0; first < count_in; first += groups_ahead * lane_count) {
        const int end = min(first + groups_ahead * lane_count, count_in);
        for (int i = first, k = 0; i < end; i += lane_count, ++k)
            met[k] = meet_pixel(environment, m, i, lanes_in_range(i, count_in), bounce);
        for (int i = first, k = 0; i < end; i += lane_count, ++k) {
            const Four<Lanes> pixel = gather4<Lanes>(environment.pixels, met[k].word);
            const Lanes other = environment_density(pixel.w, met[k].sin_theta) *
                                Lanes(scene.lights.environment_select);
            const Lanes weight = environment_weight(batch.strategies, load(m.pdf + i), other);
            const Mask exists = lanes_in_range(i, count_in);
            const LanesU slot = load(m.slot + i);
            Vec3<Lanes> light = Vec3<Lanes>{pixel.x, pixel.y, pixel.z} * weight;
            if (scene.occludes) light = light * last_occlusion(columns, exists, slot);
            light = limit_contribution(light * load3(m.tr, m.tg, m.tb, i), limit);
            add_radiance(columns.samples, exists, slot, light);
            if (columns.light_paths != nullptr)
                add_background_light(*columns.light_paths, exists, slot, light);
        }
    }
}

/// Camera rays that miss take the background colour, if there is one; those that hit are opaque.
/// Outside the camera's image the throughput is 0, and the sample stays transparent.
inline void set_camera_alpha(const BatchSettings& batch,
                             int count_in,
                             const ShadeColumns& columns) {
    const Vec3<Lanes> background{
        Lanes(batch.background[0]), Lanes(batch.background[1]), Lanes(batch.background[2])};
    for (int i = 0; i < count_in; i += lane_count) {
        const Mask is_hit = load(columns.hits.primitive + i) >= LanesI(0);
        const Mask is_clear = load(columns.paths.tr + i) == Lanes(0.0f);
        const Vec3<Lanes> seen = select(is_hit | is_clear, splat3(Lanes(0.0f)), background);
        const Lanes behind = select(is_clear, Lanes(0.0f), Lanes(batch.background[3]));
        const Lanes alpha = select(is_hit, Lanes(1.0f), behind);
        const SampleColumns& out = columns.samples;
        const Mask exists = lanes_in_range(i, count_in);
        const LanesU slot = load(columns.paths.slot + i);
        if (columns.light_paths != nullptr)
            add_background_light(*columns.light_paths, exists & (!is_hit), slot, seen);
        add_to_slots(
            exists, slot, {{out.r, seen.x}, {out.g, seen.y}, {out.b, seen.z}, {out.a, alpha}});
    }
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
