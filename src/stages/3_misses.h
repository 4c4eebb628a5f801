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
    const MissRows& m = rows.misses;
    // Camera rays look at neighbouring pixels, the others at any.
    const int step = bounce == 0 ? lane_count : groups_ahead * lane_count;
    EnvironmentCell<Lanes> cells[groups_ahead];
    for (int first = 0; first < count_in; first += step) {
        const int end = min(first + step, count_in);
        for (int i = first, k = 0; i < end; i += lane_count, ++k) {
            const Vec3<Lanes> direction = select(
                rows_in_range(i, count_in), load3(m.dx, m.dy, m.dz, i), splat3(Lanes(0.57735f)));
            cells[k] = environment_cell(scene.environment, direction);
            if (bounce > 0) prefetch_cell(scene.environment, cells[k]);
        }
        for (int i = first, k = 0; i < end; i += lane_count, ++k) {
            const Mask exists = rows_in_range(i, count_in);
            const EnvironmentTaps<Lanes> taps = environment_taps(scene.environment, cells[k]);
            const Vec3<Lanes> light =
                bounce == 0 ? mix(taps)
                            : weighted_environment(scene, batch.strategies, taps, load(m.pdf + i));
            add_radiance(
                rows.samples, exists, load(m.slot + i), light * load3(m.tr, m.tg, m.tb, i));
        }
    }
}

/// Camera rays that miss take the background colour, if there is one; those that hit are opaque.
/// Where the camera shows nothing the throughput is 0, and the sample stays clear.
inline void set_camera_alpha(const BatchSettings& batch, int count_in, const ShadeRows& rows) {
    const Vec3<Lanes> background{
        Lanes(batch.background[0]), Lanes(batch.background[1]), Lanes(batch.background[2])};
    for (int i = 0; i < count_in; i += lane_count) {
        const Mask is_hit = load(rows.hits.primitive + i) >= LanesI(0);
        const Mask is_clear = load(rows.paths.tr + i) == Lanes(0.0f);
        const Vec3<Lanes> seen = select(is_hit | is_clear, splat3(Lanes(0.0f)), background);
        const Lanes behind = select(is_clear, Lanes(0.0f), Lanes(batch.background[3]));
        const Lanes alpha = select(is_hit, Lanes(1.0f), behind);
        const SampleRows& out = rows.samples;
        add_to_slots(rows_in_range(i, count_in),
                     load(rows.paths.slot + i),
                     {{out.r, seen.x}, {out.g, seen.y}, {out.b, seen.z}, {out.a, alpha}});
    }
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
