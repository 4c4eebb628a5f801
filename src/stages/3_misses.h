// stages/3_misses.h - what paths see that leave the scene, and what pictures are opaque.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/3_lights.h"
#include "stages/3_shade.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Environment light along a ray that the BSDF chose with density `pdf`, with the MIS weight of
/// each pixel that is mixed.
OBSCURA_INLINE Vec3<Lanes> weighted_environment(const SceneView& scene,
                                                int strategies,
                                                const EnvironmentTaps<Lanes>& taps,
                                                Lanes pdf) {
    Vec3<Lanes> sum = splat3(Lanes(0.0f));
    for (int i = 0; i < 4; ++i) {
        Lanes weight = taps.weight[i];
        if (strategies == (sample_lights | sample_bsdfs)) {
            weight = weight * mis_weight(pdf, taps.pdf[i] * Lanes(scene.lights.environment_select));
        } else if (strategies == sample_lights) {
            weight = select(taps.pdf[i] > Lanes(0.0f), Lanes(0.0f), weight);
        }
        sum = sum + taps.radiance[i] * weight;
    }
    return sum;
}

/// Environment light of the paths that left the scene.
inline void shade_misses(const SceneView& scene,
                         const BatchSettings& batch,
                         int bounce,
                         int count_in,
                         const ShadeRows& rows) {
    if (!scene.has_environment || (bounce == 0 && !batch.background_visible)) return;
    for (int i = 0; i < count_in; i += lane_count) {
        const Mask exists = rows_in_range(i, count_in);
        const MissRows& m = rows.misses;
        const Vec3<Lanes> direction =
            select(exists, load3(m.dx, m.dy, m.dz, i), splat3(Lanes(0.57735f)));
        const EnvironmentTaps<Lanes> taps = environment_taps(scene.environment, direction);
        const Vec3<Lanes> light =
            bounce == 0 ? mix(taps)
                        : weighted_environment(scene, batch.strategies, taps, load(m.pdf + i));
        add_radiance(rows.samples, exists, load(m.slot + i), light * load3(m.tr, m.tg, m.tb, i));
    }
}

/// Camera rays that miss take the background colour, if there is one; those that hit are opaque.
/// Where the camera shows nothing the throughput is 0, and the sample stays clear.
inline void set_camera_alpha(const BatchSettings& batch,
                             SortedCounts sorted,
                             const ShadeRows& rows) {
    for (int i = 0; i < sorted.hits; ++i)
        rows.samples.a[rows.paths.slot[i]] = 1.0f;
    for (int i = 0; i < sorted.misses; ++i) {
        const uint32_t slot = rows.misses.slot[i];
        if (rows.misses.tr[i] == 0.0f) continue;
        rows.samples.r[slot] += batch.background[0];
        rows.samples.g[slot] += batch.background[1];
        rows.samples.b[slot] += batch.background[2];
        rows.samples.a[slot] = batch.background[3];
    }
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
