// stages/4_transparent_shadows.cpp - stage 4: transparent shadow rays, through smooth thin walls.
// SPDX-License-Identifier: Apache-2.0
#include "stages/4_transparent_shadows.h"

#include "math/sampler.h"
#include "stages/3_surface.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// A random position between texels and between mip levels. It is hashed: the pixel's Sobol points
/// have none for thin walls.
OBSCURA_INLINE Vec3<Lanes> texture_random(LanesU path_key, const ThinWallStep& step) {
    if (!step.random) return splat3(Lanes(0.5f));
    const uint32_t salt = hash_word((step.segment * 0x9E3779B9U + step.number) ^ 0x57414C4CU);
    const LanesU x = hash_word(LanesU(path_key ^ LanesU(salt)));
    const LanesU y = hash_word(LanesU(x + LanesU(0x9E3779B9U)));
    return {unit_float<Lanes>(x),
            unit_float<Lanes>(y),
            unit_float<Lanes>((y << 16) | (x & LanesU(0xFFFFU)))};
}

/// The medium stack of every ray; 0 where they have none.
OBSCURA_INLINE LanesU read_stack(const uint32_t* shadow_media, Mask exists, LanesU slot) {
    if (shadow_media == nullptr) return LanesU(0U);
    return gather<Lanes>(shadow_media, select(exists, as_int(slot), LanesI(0)));
}

/// A shadow ray as shading takes it. Light sampling reads the finest texels: it has no footprint.
OBSCURA_INLINE PathLanes as_path(const ShadowLanes& ray, LanesU medium_stack) {
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
            .medium_stack = medium_stack};
}

/// The rest of a shadow ray, from `start` to its old end. It is aimed anew because the end is clear
/// of the light by no more than the rounding error and must not move.
OBSCURA_INLINE ShadowLanes restart_on_transmitted_side(const ShadowLanes& ray,
                                                       const Vec3<Lanes>& start) {
    const Mask has_end = ray.tfar < Lanes(farthest_lamp_m);
    const Lanes reach = select(has_end, ray.tfar, Lanes(0.0f));
    const Vec3<Lanes> to_end = ray.origin + ray.direction * reach - start;
    const Lanes distance = length(to_end);
    const Mask ahead = has_end & (distance > Lanes(0.0f));
    ShadowLanes next = ray;
    next.origin = start;
    next.direction =
        select(ahead, to_end * (Lanes(1.0f) / select(ahead, distance, Lanes(1.0f))), ray.direction);
    next.tfar = select(has_end, distance, ray.tfar);
    return next;
}

}  // namespace

void absorb_shadows(const SceneView& scene, int count_in, const ShadowMediaColumns& columns) {
    const ShadowColumns& shadows = columns.shadows;
    for (int i = 0; i < count_in; i += lane_count) {
        Mask exists = lanes_in_range(i, count_in);
        if (columns.occluded != nullptr) {
            alignas(64) int32_t blocked[lane_count];
            for (int lane = 0; lane < lane_count; ++lane)
                blocked[lane] = columns.occluded[i + lane];
            exists = exists & (load(blocked) == LanesI(0));
        }
        const LanesU stack = read_stack(columns.shadow_media, exists, load(shadows.slot + i));
        Lanes distance = load(shadows.tfar + i);
        if (columns.hits.primitive != nullptr) {
            const Mask met = load(columns.hits.primitive + i) >= LanesI(0);
            distance = select(met, load(columns.hits.t + i), distance);
        }
        const Vec3<Lanes> passes = transmittance_to_light(scene, exists, stack, distance);
        const Vec3<Lanes> radiance = load3(shadows.r, shadows.g, shadows.b, i);
        store3(shadows.r, shadows.g, shadows.b, i, radiance * passes);
    }
}

int take_waiting(int count, const uint8_t* occluded, const ShadowColumns& columns) {
    uint16_t index[batch_size];
    int waiting = 0;
    for (int i = 0; i < count; ++i) {
        if (occluded[i] == waits_at_thin_wall) index[waiting++] = static_cast<uint16_t>(i);
    }
    const auto column = [&](auto* words) { take_entries(index, waiting, words, words); };
    ShadowColumns::for_each_column(column, columns);
    return waiting;
}

int cross_thin_walls(const SceneView& scene,
                     const ThinWallStep& step,
                     int count_in,
                     const ThinWallColumns& columns) {
    const Filtering filtering = step.random ? Filtering::stochastic : Filtering::bilinear;
    int out = 0;
    for (int i = 0; i < count_in; i += lane_count) {
        const Mask exists = lanes_in_range(i, count_in);
        const ShadowLanes ray = load_shadows(columns.shadows, i);
        const Mask met = exists & (load(columns.hits.primitive + i) >= LanesI(0));
        const Mask arrives = exists & (!met);
        if (any(arrives)) add_radiance(columns.samples, arrives, ray.slot, ray.radiance);
        if (none(met)) continue;
        HitLanes hit = hits_or_first(columns.hits, i, met);
        if (columns.time != nullptr) {
            hit.time = gather<Lanes>(columns.time, select(met, as_int(ray.slot), LanesI(0)));
        }
        const LanesU stack = read_stack(columns.shadow_media, met, ray.slot);
        ShadingPoint s = shading_point(
            scene, hit, as_path(ray, stack), {filtering, texture_random(ray.path_key, step)});
        if (!s.any_layers) continue;
        Vec3<Lanes> transmittance =
            take_straight(s.layers, to_local(s.frame, -ray.direction)).transmittance;
        const Boundary& boundary = s.layers.boundary;
        Mask open = s.layers.layered & (!boundary.matched);
        if (columns.shadow_media != nullptr) {
            const Mask unseen = is_passed_unseen(boundary);
            transmittance = select(unseen, splat3(Lanes(1.0f)), transmittance);
            open = s.layers.layered & ((!boundary.matched) | boundary.passable);
        }
        ShadowLanes next = restart_on_transmitted_side(ray, s.transmitted_start);
        next.radiance = ray.radiance * transmittance;
        const Mask passes = met & open & (!s.unlit) & (max_component(next.radiance) > Lanes(0.0f));
        if (columns.shadow_media != nullptr)
            store_by_slot(columns.shadow_media, passes, ray.slot, boundary.transmitted_stack);
        // In place: the entries written here have all been read.
        out = append_shadows(columns.shadows, out, passes, next);
    }
    return out;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
