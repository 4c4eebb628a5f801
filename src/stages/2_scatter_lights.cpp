// stages/2_scatter_lights.cpp - stage 2, inside scattering media: next-event estimation.
// SPDX-License-Identifier: Apache-2.0
#include "stages/2_scatter_lights.h"

#include "math/sampler.h"
#include "stages/3_light_paths.h"
#include "stages/3_lights.h"
#include "stages/contribution_limit.h"
#include "surface/scattering.h"

#include <algorithm>

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// Of more punctual lights, those that have a place are in the tree.
constexpr int max_looked_at = 64;

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
                                         const PathLanes& path,
                                         const Flight& flight) {
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
    return draw;
}

OBSCURA_INLINE Vec3<Lanes> texture_random(const PathLanes& path, const Flight& flight) {
    const auto random = [&](LightUse use) {
        return unit_float<Lanes>(hashed(path.path_key, flight, use));
    };
    return {
        random(LightUse::texture_x), random(LightUse::texture_y), random(LightUse::texture_level)};
}

/// A scattering as light sampling takes it; where paths do not scatter, the end of their way. Lanes
/// without one lie at the origin.
OBSCURA_INLINE ShadingPoint point_to_light(const ScatteringPoint& at, const float* time) {
    const Vec3<Lanes> zero = splat3(Lanes(0.0f));
    const Mask exists = at.exists | at.way.exists;
    const Lanes distance = min(at.distance_m, at.way.end_m);
    ShadingPoint point{};
    point.light_start = select(exists, at.path.origin + at.path.direction * distance, zero);
    point.time = Lanes(0.0f);
    if (time != nullptr) {
        point.time = gather<Lanes>(time, select(exists, as_int(at.path.slot), LanesI(0)));
    }
    return point;
}

/// Light that scatters towards the path's start.
struct WalkLight {
    Mask exists;
    Vec3<Lanes> place;
    Vec3<Lanes> throughput;
    LightLanes light;
};

OBSCURA_INLINE EquiangularSegment<Lanes> equiangular_segment(const ScatteringPoint& at,
                                                             const WalkLight& lit) {
    const PathLanes& path = at.path;
    const Vec3<Lanes> light = lit.place + lit.light.direction * lit.light.distance;
    const Vec3<Lanes> to_light = light - path.origin;
    const Lanes ahead = dot(to_light, path.direction);
    const Lanes aside = length(to_light - path.direction * ahead);
    // Farther into the medium hardly any light comes from.
    const Lanes mean = dot(at.way.probability, at.way.extinction);
    const Lanes end = min(at.way.end_m, Lanes(6.0f) / max(mean, Lanes(1e-30f)));
    return {ahead, max(aside, (end + abs(ahead)) * Lanes(1e-5f)), end};
}

/// The way from each place to the punctual light that lights it most brightly, as far as intensity
/// and distance tell.
OBSCURA_INLINE Vec3<Lanes> to_brightest_light(const SceneView& scene, const Vec3<Lanes>& place) {
    constexpr auto directional = static_cast<int32_t>(PunctualType::directional);
    Vec3<Lanes> out = splat3(Lanes(0.0f));
    Lanes most(0.0f);
    const int count = std::min(scene.lights.punctual_count, max_looked_at);
    for (int i = 0; i < count; ++i) {
        const PunctualLight& light = scene.lights.punctual[i];
        if (light.type == directional) continue;
        const Vec3<Lanes> way =
            Vec3<Lanes>{
                Lanes(light.position[0]), Lanes(light.position[1]), Lanes(light.position[2])} -
            place;
        const float* const candela = light.intensity;
        const float intensity = std::max(candela[0], std::max(candela[1], candela[2]));
        const Lanes bright = Lanes(intensity) / max(dot(way, way), Lanes(1e-30f));
        out = select(bright > most, way, out);
        most = max(most, bright);
    }
    return out;
}

OBSCURA_INLINE Vec3<Lanes> left_after(const WayThrough& way, Lanes distance) {
    return {exp(-(way.extinction.x * distance)),
            exp(-(way.extinction.y * distance)),
            exp(-(way.extinction.z * distance))};
}

/// Samples lights without size all along the way. Paths that do not scatter choose a place near the
/// light; those that do, there or where they scatter, with equal chances.
///
/// In      u: uniform in [0, 1)^2; sample_from: light sampling at another place
/// In/Out  lit: of the lights at the paths' scatterings
template <typename SampleFrom>
OBSCURA_INLINE void sample_along_way(const ScatteringPoint& at,
                                     Mask on_way,
                                     const Vec2<Lanes>& u,
                                     const SampleFrom& sample_from,
                                     WalkLight& lit) {
    const PathLanes& path = at.path;
    const WayThrough& way = at.way;
    const EquiangularSegment<Lanes> segment = equiangular_segment(at, lit);
    const Mask is_near = on_way & ((!at.exists) | (u.x < Lanes(0.5f)));
    const Lanes distance = select(is_near, segment.sample(u.y), at.distance_m);
    const Vec3<Lanes> extinguished = way.extinction * left_after(way, distance);
    const Lanes passes = dot(way.probability, left_after(way, way.end_m));
    const Lanes pdf = Lanes(0.5f) * (dot(way.probability, extinguished) +
                                     (Lanes(1.0f) + passes) * segment.pdf(distance));
    const Vec3<Lanes> throughput =
        path.throughput * way.albedo * extinguished * (Lanes(1.0f) / max(pdf, Lanes(1e-30f)));
    lit.throughput = select(on_way, throughput, lit.throughput);
    lit.place = select(is_near, path.origin + path.direction * distance, lit.place);
    choose(lit.light, is_near, sample_from(lit.place));
    lit.exists = is_near | lit.exists;
}

/// How paths go on from where they scatter: by the phase function, but near a light without size a
/// quarter of them to where that is near. What scatters there lights this place, too, and the phase
/// function seldom finds it.
struct Turn {
    Mask is_guided;
    Vec3<Lanes> to_light;  ///< unit
    static constexpr float guided_share = 0.25f;
};

OBSCURA_INLINE Turn turn_at(const SceneView& scene,
                            const ScatteringPoint& at,
                            const Vec3<Lanes>& place) {
    const Vec3<Lanes> way = to_brightest_light(scene, place);
    const Lanes distance = length(way);
    const Lanes mean = dot(at.way.probability, at.way.extinction);
    const Mask is_near =
        at.exists & at.way.exists & (distance * mean < Lanes(3.0f)) & (distance > Lanes(1e-18f));
    const Vec3<Lanes> any_axis{Lanes(0.0f), Lanes(0.0f), Lanes(1.0f)};
    return {is_near, select(is_near, way * (Lanes(1.0f) / distance), any_axis)};
}

/// Density of a direction, 1/sr: also that which light sampling is weighed against.
///
/// In      phase: of the phase function
OBSCURA_INLINE Lanes turn_pdf(const Turn& turn, const Vec3<Lanes>& direction, Lanes phase) {
    constexpr float share = Turn::guided_share;
    // Equal angles from the light are equally likely.
    const Lanes sine = max(length(cross(direction, turn.to_light)), Lanes(1e-5f));
    const Lanes guided = exact_constant<Lanes>(0.5 / (pi_d * pi_d)) / sine;
    return select(turn.is_guided, Lanes(1.0f - share) * phase + Lanes(share) * guided, phase);
}

/// Directions of which a quarter is drawn to the light.
///
/// In      at.turn: uniform in [0, 1)^2; both kinds use it up
OBSCURA_INLINE Vec3<Lanes> guided_direction(const ScatteringPoint& at, const Turn& turn) {
    const Lanes share(Turn::guided_share);
    const Mask to_light = at.turn.x < share;
    // What is left of the first number is as good as new.
    const Lanes left =
        select(to_light, at.turn.x / share, (at.turn.x - share) / (Lanes(1.0f) - share));
    const SinCos<Lanes> angle = sin_cos_turn(left * Lanes(0.5f));
    const SinCos<Lanes> around = sin_cos_turn(at.turn.y);
    const Vec3<Lanes> local{angle.sin * around.cos, angle.sin * around.sin, angle.cos};
    const Vec3<Lanes> guided = normalize(to_world(frame_around(turn.to_light), local));
    return select(
        to_light, guided, scatter_direction(at.path.direction, at.anisotropy, {left, at.turn.y}));
}

/// In/Out  next: the paths with their turns by the phase function; direction, throughput and pdf
///         change
OBSCURA_INLINE void guide(const ScatteringPoint& at, const Turn& turn, PathLanes& next) {
    const Mask guided = turn.is_guided;
    if (any(guided)) next.direction = select(guided, guided_direction(at, turn), next.direction);
    const Lanes phase = henyey_greenstein(at.anisotropy, dot(at.path.direction, next.direction));
    const Lanes pdf = turn_pdf(turn, next.direction, phase);
    next.throughput = select(guided, next.throughput * (phase / pdf), next.throughput);
    next.pdf = select(at.exists, pdf, next.pdf);
}

/// Weight of sampled light that a path may also meet by its turn: of lights that have a size.
OBSCURA_INLINE Lanes weight_beside_turns(int strategies, const LightLanes& light, Lanes by_turn) {
    const Lanes one(1.0f);
    const Mask has_size = light.pdf > Lanes(0.0f);
    if (strategies == sample_bsdfs) return select(has_size, Lanes(0.0f), one);
    if (strategies == sample_lights) return one;
    return select(has_size, mis_weight(light.pdf, by_turn), one);
}

}  // namespace

Mask samples_lights(const WalkingBatch& walk, LanesI medium, Lanes ior) {
    const auto around = static_cast<int32_t>(walk.batch.medium_stack >> 16U & 255U);
    const Mask passable = Mask(walk.scene.passable_media) & is_like_air(ior);
    return passable | (medium == LanesI(around));
}

bool has_point_lights(const SceneView& scene) {
    const LightView& lights = scene.lights;
    constexpr auto directional = static_cast<int32_t>(PunctualType::directional);
    const int count = std::min(lights.punctual_count, max_looked_at);
    for (int i = 0; i < count; ++i) {
        const bool is_of_tree = lights.tree.nodes != nullptr && lights.select_pdf[i] >= 1.0f;
        if (lights.punctual[i].type != directional && !is_of_tree) return true;
    }
    return false;
}

void add_light_samples(const WalkingBatch& walk,
                       const ScatteringPoint& at,
                       const ScatterColumns& columns,
                       PathLanes& next,
                       int& count) {
    const SceneView& scene = walk.scene;
    const PathLanes& path = at.path;
    const ShadingPoint point = point_to_light(at, columns.time);
    const Turn turn = turn_at(scene, at, point.light_start);
    guide(at, turn, next);
    LightDraw draw = draw_walk_light(scene, path, walk.flight);
    const Mask is_punctual = draw.light < LanesI(scene.lights.punctual_count);
    if (scene.lights.tree.nodes != nullptr) {
        const LitPoint<Lanes> here{point.light_start, splat3(Lanes(0.0f))};
        draw_light_of_tree(scene, here, at.exists, draw);
        if (columns.lit_points != nullptr)
            note_lit_points(columns.lit_points, at.exists, path.slot, here);
    }
    const Vec3<Lanes> texture = texture_random(path, walk.flight);
    WalkLight lit{
        at.exists, point.light_start, at.throughput, sample_light(scene, point, draw, texture)};
    const Mask on_way = at.way.exists & is_punctual & (lit.light.distance < Lanes(farthest_lamp_m));
    if (any(on_way)) {
        const auto sample_from = [&](const Vec3<Lanes>& place) {
            return sample_light_from(scene, {place, point.time}, draw, texture);
        };
        // A light without size leaves the numbers of the place on it unused. Chosen by these, the
        // place on the way is stratified together with the light.
        sample_along_way(at, on_way, draw.place, sample_from, lit);
    }
    const LightLanes& light = lit.light;
    const Lanes phase = henyey_greenstein(at.anisotropy, dot(path.direction, light.direction));
    const Lanes weight =
        weight_beside_turns(walk.batch.strategies, light, turn_pdf(turn, light.direction, phase));
    Vec3<Lanes> radiance = lit.throughput * light.radiance_over_pdf * (phase * weight);
    Mask useful = lit.exists & light.valid;
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
                           {.origin = lit.place,
                            .direction = light.direction,
                            .tfar = light.distance,
                            .radiance = radiance,
                            .slot = path.slot,
                            .path_key = path.path_key});
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
