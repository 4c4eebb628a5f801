// stages/4_walls.cpp - stage 4, where there are thin walls: shadow rays go on behind them.
// SPDX-License-Identifier: Apache-2.0
#include "stages/4_walls.h"

#include "math/sampler.h"
#include "stages/3_surface.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// Shorter rays have an end that counts; see directional_distance_m.
constexpr float farthest_lamp_m = 1e18f;

/// A place between texels and between mip levels. Crossings have no place in the pixel's Sobol
/// points: theirs is hashed.
OBSCURA_INLINE Vec3<Lanes> texture_random(LanesU path_key, const WallStep& step) {
    if (!step.random) return splat3(Lanes(0.5f));
    const uint32_t salt = hash_word((step.segment * 0x9E3779B9U + step.number) ^ 0x57414C4CU);
    const LanesU x = hash_word(LanesU(path_key ^ LanesU(salt)));
    const LanesU y = hash_word(LanesU(x + LanesU(0x9E3779B9U)));
    return {unit_float<Lanes>(x),
            unit_float<Lanes>(y),
            unit_float<Lanes>((y << 16) | (x & LanesU(0xFFFFU)))};
}

/// A shadow ray as shading takes it. Light sampling reads the finest texels: it has no footprint.
OBSCURA_INLINE PathLanes as_path(const ShadowLanes& ray) {
    const Lanes zero(0.0f);
    const LanesU none_yet(0U);
    return {.origin = ray.origin,
            .direction = ray.direction,
            .throughput = ray.radiance,
            .pdf = zero,
            .cone_width = zero,
            .cone_spread = zero,
            .slot = ray.slot,
            .key = none_yet,
            .sample = none_yet,
            .path_key = ray.path_key,
            .bodies = none_yet};
}

/// The rest of the way to where a ray ends: aimed anew, so that starting clear of the wall does not
/// move its end, which is clear of the light by what rounding takes and no more.
OBSCURA_INLINE ShadowLanes from_beyond(const ShadowLanes& ray, const Vec3<Lanes>& start) {
    const Mask has_end = ray.tfar < Lanes(farthest_lamp_m);
    const Lanes reach = select(has_end, ray.tfar, Lanes(0.0f));
    const Vec3<Lanes> way = ray.origin + ray.direction * reach - start;
    const Lanes distance = length(way);
    const Mask ahead = has_end & (distance > Lanes(0.0f));
    ShadowLanes next = ray;
    next.origin = start;
    next.direction =
        select(ahead, way * (Lanes(1.0f) / select(ahead, distance, Lanes(1.0f))), ray.direction);
    next.tfar = select(has_end, distance, ray.tfar);
    return next;
}

}  // namespace

int take_waiting(int count, const uint8_t* occluded, const ShadowRows& rows) {
    uint16_t row[batch_rows];
    int waiting = 0;
    for (int i = 0; i < count; ++i) {
        if (occluded[i] == waits_at_wall) row[waiting++] = static_cast<uint16_t>(i);
    }
    const auto column = [&](auto* words) { take_rows(row, waiting, words, words); };
    ShadowRows::for_each_column(column, rows);
    return waiting;
}

int cross_walls(const SceneView& scene, const WallStep& step, int count_in, const WallRows& rows) {
    const Filtering filtering = step.random ? Filtering::stochastic : Filtering::bilinear;
    int out = 0;
    for (int i = 0; i < count_in; i += lane_count) {
        const Mask exists = rows_in_range(i, count_in);
        const ShadowLanes ray = load_shadows(rows.shadows, i);
        const Mask met = exists & (load(rows.hits.primitive + i) >= LanesI(0));
        const Mask arrives = exists & (!met);
        if (any(arrives)) add_radiance(rows.samples, arrives, ray.slot, ray.radiance);
        if (none(met)) continue;
        HitLanes hit = hits_or_first(rows.hits, i, met);
        if (rows.time != nullptr) {
            hit.time = gather<Lanes>(rows.time, select(met, as_int(ray.slot), LanesI(0)));
        }
        ShadingPoint s = shading_point(
            scene, hit, as_path(ray), {filtering, texture_random(ray.path_key, step)});
        if (!s.any_layers) continue;
        const StraightLight<Lanes> light =
            take_straight(s.layers, to_local(s.frame, -ray.direction));
        ShadowLanes next = from_beyond(ray, s.start_beyond);
        next.radiance = ray.radiance * light.transmittance;
        const Mask passes = met & (!s.unlit) & (max_component(next.radiance) > Lanes(0.0f)) &
                            s.layers.layered & (!s.layers.boundary.matched);
        // In place: the rows written here have all been read.
        out = append_shadows(rows.shadows, out, passes, next);
    }
    return out;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
