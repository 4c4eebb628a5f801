// stages/2_scatter_lights.cpp - stage 2, inside scattering media: next-event estimation.
// SPDX-License-Identifier: Apache-2.0
#include "stages/2_scatter_lights.h"

#include "math/sampler.h"
#include "stages/3_light_paths.h"
#include "stages/3_lights.h"
#include "stages/contribution_limit.h"
#include "surface/scattering.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// The uses of the random numbers with which a flight's end samples lights.
enum class LightUse : uint32_t { x, y, texture_x, texture_y, texture_level, count };

OBSCURA_INLINE LanesU hashed(LanesU path_key, const Flight& flight, LightUse use) {
    const uint32_t number =
        (static_cast<uint32_t>(flight.bounce) << 20U) +
        static_cast<uint32_t>(flight.number) * static_cast<uint32_t>(LightUse::count) +
        static_cast<uint32_t>(use);
    return hash_word(LanesU(path_key ^ LanesU(hash_word(number ^ 0x4C414D50U))));
}

/// The light that each path samples. The first scattering has the pixel's Sobol points, of which
/// surfaces use those of a bounce too; later ones have none.
OBSCURA_INLINE LightDraw draw_walk_light(const SceneView& scene,
                                         const ScatteringPoint& scattering,
                                         const Flight& flight,
                                         const LitPoint<Lanes>& at) {
    const PathLanes& path = scattering.path;
    Vec2<LanesU> random;
    if (flight.number == 0) {
        const uint32_t pair = static_cast<uint32_t>(flight.bounce) * pairs_per_bounce +
                              static_cast<uint32_t>(RandomUse::light);
        random = sobol_pair(path.key, path.sample, pair);
    } else {
        random = {hashed(path.path_key, flight, LightUse::x),
                  hashed(path.path_key, flight, LightUse::y)};
    }
    LightDraw draw = draw_light(scene, random);
    draw_light_pixel(scene, draw);
    if (scene.lights.tree.nodes != nullptr) draw_light_of_tree(scene, at, scattering.exists, draw);
    return draw;
}

OBSCURA_INLINE Vec3<Lanes> texture_random(const PathLanes& path, const Flight& flight) {
    const auto random = [&](LightUse use) {
        return unit_float<Lanes>(hashed(path.path_key, flight, use));
    };
    return {
        random(LightUse::texture_x), random(LightUse::texture_y), random(LightUse::texture_level)};
}

/// A scattering as light sampling takes it. Lanes without one lie at the origin.
OBSCURA_INLINE ShadingPoint point_to_light(const ScatteringPoint& at, const float* time) {
    const Vec3<Lanes> zero = splat3(Lanes(0.0f));
    ShadingPoint point{};
    point.light_start = select(at.exists, at.position, zero);
    point.time = Lanes(0.0f);
    if (time != nullptr) {
        point.time = gather<Lanes>(time, select(at.exists, as_int(at.path.slot), LanesI(0)));
    }
    return point;
}

}  // namespace

Mask samples_lights(const WalkingBatch& walk, LanesI medium, Lanes ior) {
    const auto around = static_cast<int32_t>(walk.batch.medium_stack >> 16U & 255U);
    const Mask passable = Mask(walk.scene.passable_media) & is_like_air(ior);
    return passable | (medium == LanesI(around));
}

void add_light_samples(const WalkingBatch& walk,
                       const ScatteringPoint& at,
                       const ScatterColumns& columns,
                       int& count) {
    const SceneView& scene = walk.scene;
    const PathLanes& path = at.path;
    const ShadingPoint point = point_to_light(at, columns.time);
    const LitPoint<Lanes> lit{point.light_start, splat3(Lanes(0.0f))};
    const LightDraw draw = draw_walk_light(scene, at, walk.flight, lit);
    if (columns.lit_points != nullptr)
        note_lit_points(columns.lit_points, at.exists, path.slot, lit);
    const LightLanes light = sample_light(scene, point, draw, texture_random(path, walk.flight));
    const Lanes phase = henyey_greenstein(at.anisotropy, dot(path.direction, light.direction));
    const int strategies = walk.batch.strategies;
    Lanes weight(1.0f);
    if (strategies == (sample_lights | sample_bsdfs))
        weight = select(light.pdf > Lanes(0.0f), mis_weight(light.pdf, phase), weight);
    Vec3<Lanes> radiance = at.throughput * light.radiance_over_pdf * (phase * weight);
    Mask useful = at.exists & light.valid;
    if (strategies == sample_bsdfs) useful = useful & (light.pdf == Lanes(0.0f));
    if (columns.shadow_media == nullptr) {
        radiance =
            radiance * transmittance_to_light(scene, useful, path.medium_stack, light.distance);
    }
    // All flights of a bounce count as one scattering.
    radiance = limit_contribution(radiance, contribution_limit(walk.batch, walk.flight.bounce + 1));
    useful = useful & (max_component(radiance) > Lanes(0.0f));
    if (none(useful)) return;
    if (columns.shadow_media != nullptr)
        store_by_slot(columns.shadow_media, useful, path.slot, path.medium_stack);
    if (columns.light_paths != nullptr)
        note_shadow_class(*columns.light_paths, useful, path.slot, draw.light);
    count = append_shadows(columns.shadows,
                           count,
                           useful,
                           {.origin = point.light_start,
                            .direction = light.direction,
                            .tfar = light.distance,
                            .radiance = radiance,
                            .slot = path.slot,
                            .path_key = path.path_key});
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
