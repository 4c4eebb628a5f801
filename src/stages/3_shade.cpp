// stages/3_shade.cpp - stage 3: hits become radiance, shadow rays and the next rays.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_shade.h"

#include "math/sampler.h"
#include "stages/3_lights.h"
#include "stages/3_misses.h"
#include "stages/3_rough_paths.h"
#include "stages/3_scatter.h"
#include "stages/3_thin_walls.h"
#include "stages/contribution_limit.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// The first bounces bring most of the light, and the rare bright paths among them most of the
/// noise: ending some of them saves few rays and makes the others brighter still.
constexpr int bounces_before_roulette = 2;

/// The random numbers of one bounce.
struct BounceRandom {
    Vec2<Lanes> bsdf;
    Lanes roulette;
    Vec3<Lanes> texture;
};

OBSCURA_INLINE Vec2<LanesU> random_pair(LanesU key, LanesU sample, int bounce, RandomUse use) {
    const uint32_t number =
        static_cast<uint32_t>(bounce) * pairs_per_bounce + static_cast<uint32_t>(use);
    return sobol_pair(key, sample, number);
}

OBSCURA_INLINE BounceRandom bounce_random(const PathLanes& path, int bounce) {
    const auto pair = [&](RandomUse use) {
        return random_pair(path.key, path.sample, bounce, use);
    };
    BounceRandom r;
    r.bsdf = unit_pair<Lanes>(pair(RandomUse::bsdf));
    r.roulette = bounce < bounces_before_roulette ? Lanes(0.0f)
                                                  : unit_float<Lanes>(pair(RandomUse::roulette).x);
    // A position between texels, and from the remaining bits one between mip levels.
    const Vec2<LanesU> bits = pair(RandomUse::texture);
    const Vec2<Lanes> texel = unit_pair<Lanes>(bits);
    r.texture = {texel.x, texel.y, unit_float<Lanes>((bits.y << 16) | (bits.x & LanesU(0xFFFFU)))};
    return r;
}

/// What the paths of one bounce share.
struct Bounce {
    const SceneView& scene;
    const BatchSettings& batch;
    int number;
    bool is_over;                         ///< paths do not scatter any more
    const LightPathColumns* light_paths;  ///< null: no light layers are asked for
    float limit_of_found;                 ///< contribution_limit of light that the paths met
    float limit_of_sampled;               ///< and of what their shadow rays bring
    bool marks_paths;                     ///< by their scatterings: scattered_roughly and others
};

OBSCURA_INLINE Bounce begin_bounce(const SceneView& scene,
                                   const BatchSettings& batch,
                                   int number,
                                   const ShadeColumns& columns) {
    return {.scene = scene,
            .batch = batch,
            .number = number,
            .is_over = number > batch.max_bounces,
            .light_paths = columns.light_paths,
            .limit_of_found = contribution_limit(batch, number),
            .limit_of_sampled = contribution_limit(batch, number + 1),
            .marks_paths = batch.regularize || !batch.caustics || batch.clear_spread >= 0.0f};
}

/// One group of paths at their hits.
struct ShadedGroup {
    const PathLanes& path;
    ShadingPoint& s;
    BounceRandom& random;
    LightDraw& light;
    const HitLanes& hit;
};

/// Draws lights for the groups that start at index `first`.
OBSCURA_INLINE void draw_ahead(const Bounce& bounce,
                               const PathView& paths,
                               int first,
                               int groups,
                               LightDraw (&draws)[groups_ahead]) {
    const SceneView& scene = bounce.scene;
    if (scene.lights.count == 0) return;
    for (int g = 0; g < groups; ++g) {
        const int i = first + g * lane_count;
        const Vec2<LanesU> random = random_pair(
            load(paths.key + i), load(paths.sample + i), bounce.number, RandomUse::light);
        draws[g] = draw_light(scene, random);
    }
    for (int g = 0; g < groups; ++g)
        draw_light_pixel(scene, draws[g]);
}

/// Hits before misses; paths that the light tree chooses a light for come after the others.
OBSCURA_INLINE SortedCounts sort_paths(const Bounce& bounce,
                                       int count_in,
                                       const ShadeColumns& columns) {
    const LightTreeView& tree = bounce.scene.lights.tree;
    const bool all_by_tree = tree.first_random == 0;  // there are no other lights
    if (tree.nodes == nullptr || all_by_tree || bounce.is_over)
        return sort_hits_from_misses(count_in, columns);
    TreeDraws draws;
    for (int i = 0; i < count_in; i += lane_count) {
        const LanesU random = random_pair(load(columns.paths.key + i),
                                          load(columns.paths.sample + i),
                                          bounce.number,
                                          RandomUse::light)
                                  .x;
        const Mask by_tree = as_int(random >> 2) >= LanesI(tree.first_random);
        draws.by_group[i / lane_count] = static_cast<uint16_t>(mask_bits(by_tree));
    }
    return sort_hits_from_misses(count_in, columns, &draws);
}

/// Probability with which the light tree chose the emitters that BSDF rays hit.
OBSCURA_INLINE Lanes chosen_by_tree(const SceneView& scene,
                                    const ShadeColumns& columns,
                                    Mask met,
                                    const ShadedGroup& group) {
    if (none(met)) return Lanes(0.0f);
    const LanesI light = group.s.light + LanesI(scene.lights.punctual_count);
    const LanesU slot = group.path.slot;  // only a copy has an address
    return probability_by_tree(scene.lights.tree, columns.lit_points, light, slot, met);
}

/// The light tree's choice for paths that sample a light, and its place for those that turn.
OBSCURA_INLINE void choose_by_tree(const SceneView& scene,
                                   const ShadeColumns& columns,
                                   Mask turns,
                                   Mask scatters,
                                   const ShadedGroup& group) {
    if (columns.lit_points == nullptr) return;
    const LitPoint<Lanes> lit = lit_point(group.s);
    note_lit_points(columns.lit_points, turns, group.path.slot, lit);
    draw_light_of_tree(scene, lit, scatters, group.light);
}

/// Adds the emission of the hit surfaces.
OBSCURA_INLINE void add_emission(const Bounce& bounce,
                                 const ShadeColumns& columns,
                                 Mask active,
                                 const ShadedGroup& group) {
    const SceneView& scene = bounce.scene;
    const BatchSettings& batch = bounce.batch;
    const PathLanes& path = group.path;
    const ShadingPoint& s = group.s;
    const Mask glows = active & (max_component(s.emission) > Lanes(0.0f));
    Vec3<Lanes> light = splat3(Lanes(0.0f));
    if (any(glows)) {
        const Mask chosen_by_bsdf = path.pdf > Lanes(0.0f);
        Lanes weight(1.0f);
        if (batch.strategies == (sample_lights | sample_bsdfs)) {
            PathLanes chosen = path;  // with the ray's origin and density at the last scattering
            Lanes path_length = group.hit.t;
            if (columns.distance_since_scattering != nullptr) {
                const Lanes straight = read_distance_since_scattering(columns, glows, path);
                path_length = path_length + straight;
                chosen.origin = path.origin - path.direction * straight;
            }
            Lanes other = light_pdf(scene, s, path.direction, path_length);
            if (scene.lights.shape_count > 0) {
                other = shape_light_pdf(scene, s.light, chosen, s.ng, {path_length, other});
            }
            if (columns.lit_points != nullptr) {
                const Mask met = glows & chosen_by_bsdf & (s.light >= LanesI(0));
                other = other * chosen_by_tree(scene, columns, met, group);
            }
            weight = select(chosen_by_bsdf, mis_weight(path.pdf, other), weight);
        } else if (batch.strategies == sample_lights) {
            weight = select(chosen_by_bsdf & (s.light >= LanesI(0)), Lanes(0.0f), weight);
        }
        if (s.any_layers) {
            const LanesI sampled = select(glows & chosen_by_bsdf, s.light, LanesI(-1));
            const Lanes cosine = abs(dot(s.ng, path.direction));
            weight = weight * sampled_coat_transmittance(scene, sampled, cosine);
        }
        light = select(glows, s.emission * weight, light);
    }
    const Mask unlit = active & s.unlit;
    light = select(unlit, light + s.bsdf.base_color, light);
    const Mask any_light = glows | unlit;
    if (none(any_light)) return;
    light = limit_contribution(path.throughput * light, bounce.limit_of_found);
    add_radiance(columns.samples, any_light, path.slot, light);
    if (bounce.light_paths != nullptr)
        add_emitted_light(*bounce.light_paths, any_light, group.hit, path.slot, light);
}

/// Samples lamps behind surfaces that let light through anew, from where the shadow ray starts: a
/// lamp that is near would else be blocked by itself, and one that lets light through would shine
/// upon itself.
OBSCURA_INLINE void sample_from_transmitted_side(const SceneView& scene,
                                                 Mask active,
                                                 const ShadedGroup& group,
                                                 LightLanes& light) {
    const ShadingPoint& s = group.s;
    if (!s.any_layers) return;
    const Mask behind = active & light.valid & s.layers.lets_through &
                        (dot(light.direction, s.ng) <= Lanes(0.0f)) &
                        (light.distance < Lanes(directional_distance_m));
    if (none(behind)) return;
    const Vec3<Lanes> place = s.transmitted_start, texture = group.random.texture;
    const Lanes time = s.time;  // only copies have an address
    const LightDraw draw = group.light;
    LightLanes found = sample_light_from(scene, {place, time}, draw, texture);
    found.valid = found.valid & (dot(found.direction, s.ng) <= Lanes(0.0f));
    choose(light, behind, found);
}

/// Writes the shadow rays of one group; returns their new count.
OBSCURA_INLINE int add_shadow_rays(const Bounce& bounce,
                                   const ShadeColumns& columns,
                                   int at,
                                   Mask active,
                                   const ShadedGroup& group) {
    const SceneView& scene = bounce.scene;
    const BatchSettings& batch = bounce.batch;
    const PathLanes& path = group.path;
    const ShadingPoint& s = group.s;
    LightLanes light = sample_light(scene, s, group.light, group.random.texture);
    sample_from_transmitted_side(scene, active, group, light);
    const Vec3<Lanes> wo = to_local(s.frame, -path.direction);
    const Vec3<Lanes> wi = to_local(s.frame, light.direction);
    const Mask reflected_side = dot(light.direction, s.ng) > Lanes(0.0f);
    Mask useful = active & light.valid & may_leave(s, reflected_side, wi);
    if (none(useful)) return at;
    const BsdfValue<Lanes> bsdf = evaluate_point(s, wo, wi);
    const bool both = batch.strategies == (sample_lights | sample_bsdfs);
    const Lanes weight =
        both ? select(light.pdf > Lanes(0.0f), mis_weight(light.pdf, bsdf.pdf), Lanes(1.0f))
             : Lanes(1.0f);
    Vec3<Lanes> radiance = path.throughput * bsdf.value_cos * light.radiance_over_pdf * weight;
    if (s.any_layers) radiance = radiance * wavelength_tint(s, reflected_side);
    if (scene.occludes)
        radiance = radiance * select(is_environment(light), s.occlusion, Lanes(1.0f));
    if (scene.media != nullptr) {
        const LanesU medium_stack =
            s.any_layers
                ? select(reflected_side, path.medium_stack, s.layers.boundary.transmitted_stack)
                : path.medium_stack;
        if (columns.shadow_media != nullptr) {  // stage 4 attenuates
            store_by_slot(columns.shadow_media, useful, path.slot, medium_stack);
        } else {
            radiance =
                radiance * transmittance_to_light(scene, useful, medium_stack, light.distance);
        }
    }
    radiance = limit_contribution(radiance, bounce.limit_of_sampled);
    useful = useful & (max_component(radiance) > Lanes(0.0f));
    if (batch.strategies == sample_bsdfs) useful = useful & (light.pdf == Lanes(0.0f));
    if (bounce.light_paths != nullptr && any(useful)) {
        scatter_shadow(*bounce.light_paths,
                       useful,
                       path.slot,
                       group.light.light,
                       {s, {wo, wi, bsdf.value_cos}});
    }
    const Vec3<Lanes> start =
        s.any_layers ? select(reflected_side, s.light_start, s.transmitted_start) : s.light_start;
    return append_shadows(columns.shadows,
                          at,
                          useful,
                          {.origin = start,
                           .direction = light.direction,
                           .tfar = light.distance,
                           .radiance = radiance,
                           .slot = path.slot,
                           .path_key = path.path_key});
}

/// Probability of surviving Russian roulette after a bounce; survivors are divided by it.
OBSCURA_INLINE Lanes survival(const Vec3<Lanes>& throughput, int bounce) {
    if (bounce < bounces_before_roulette) return Lanes(1.0f);
    return clamp(max_component(throughput), Lanes(0.05f), Lanes(1.0f));
}

/// The random numbers that choose a direction. Only transmissive surfaces read the third: it is the
/// unused half of the roulette's pair.
OBSCURA_INLINE Vec3<Lanes> direction_random(const PathLanes& path,
                                            const ShadingPoint& s,
                                            const BounceRandom& random,
                                            int bounce) {
    Lanes facet(0.0f);
    if (s.any_layers && any(s.layers.lets_through)) {
        facet =
            unit_float<Lanes>(random_pair(path.key, path.sample, bounce, RandomUse::roulette).y);
    }
    return {random.bsdf.x, random.bsdf.y, facet};
}

/// Writes the next rays of one group; returns their new count.
OBSCURA_INLINE int add_next_rays(const Bounce& bounce,
                                 const PathColumns& columns,
                                 int at,
                                 Mask active,
                                 const ShadedGroup& group) {
    const PathLanes& path = group.path;
    const ShadingPoint& s = group.s;
    const BounceRandom& random = group.random;
    const Vec3<Lanes> wo = to_local(s.frame, -path.direction);
    const Vec3<Lanes> u = direction_random(path, s, random, bounce.number);
    const BsdfSample<Lanes> sample = sample_point(s, wo, u);
    const Vec3<Lanes> direction = normalize(to_world(s.frame, sample.direction));
    const Mask reflected_side = dot(direction, s.ng) > Lanes(0.0f);
    Mask goes_on =
        active & (sample.at.pdf > Lanes(0.0f)) & may_leave(s, reflected_side, sample.direction);
    if (none(goes_on)) return at;
    Vec3<Lanes> weight = sample.at.value_cos * (Lanes(1.0f) / max(sample.at.pdf, Lanes(1e-30f)));
    if (s.any_layers) weight = weight * wavelength_tint(s, reflected_side);
    const Vec3<Lanes> throughput = path.throughput * weight;
    const Lanes survives = survival(throughput, bounce.number);
    goes_on = goes_on & (random.roulette < survives) & (max_component(throughput) > Lanes(0.0f));
    if (bounce.light_paths != nullptr && any(goes_on))
        scatter_path(*bounce.light_paths,
                     goes_on,
                     path.slot,
                     {s, {wo, sample.direction, sample.at.value_cos}});
    PathLanes next;
    next.origin = s.start;
    next.direction = direction;
    next.throughput = throughput * (Lanes(1.0f) / survives);
    next.pdf = sample.at.pdf;
    next.cone_width = path.cone_width + path.cone_spread * group.hit.t;
    next.cone_spread = path.cone_spread + sample.spread;
    next.slot = path.slot;
    next.key = path.key;
    next.sample = path.sample;
    next.path_key = path.path_key;
    next.medium_stack = path.medium_stack;
    if (s.any_layers) {
        next.origin = select(reflected_side, next.origin, s.transmitted_start);
        next.medium_stack = medium_stack_towards(s, path.medium_stack, reflected_side);
    }
    if (bounce.marks_paths) {
        const LanesU none(0U);
        const Mask unclear = reflected_side | (sample.spread > Lanes(bounce.batch.clear_spread));
        next.medium_stack = next.medium_stack |
                            select(is_rough(sample.spread), LanesU(scattered_roughly), none) |
                            select(unclear, LanesU(seen_unclearly), none);
    }
    return append_paths(columns, at, goes_on, next);
}

/// Rays pass straight through boundaries inside a medium of higher priority.
OBSCURA_INLINE int add_passing_rays(const PathColumns& columns,
                                    int at,
                                    Mask active,
                                    const ShadedGroup& group) {
    const PathLanes& path = group.path;
    const ShadingPoint& s = group.s;
    const Mask passes = active & s.layers.layered & s.layers.boundary.hidden;
    if (none(passes)) return at;
    PathLanes next = path;
    next.origin = s.transmitted_start;
    next.medium_stack = s.layers.boundary.transmitted_stack;
    // Elsewhere, light sampling does not reach through the surface.
    next.pdf = select(s.layers.boundary.passable, path.pdf, Lanes(0.0f));
    next.cone_width = path.cone_width + path.cone_spread * group.hit.t;
    return append_paths(columns, at, passes, next);
}

/// Lets paths pass smooth thin walls; the layers' remaining lobes are sampled with `random`.
OBSCURA_INLINE PassedThinWalls add_straight_rays(const ShadeColumns& columns,
                                                 int at,
                                                 Mask scatters,
                                                 const ShadedGroup& group,
                                                 const Bounce& bounce) {
    const PathLanes& path = group.path;
    ShadingPoint& s = group.s;
    BounceRandom& random = group.random;
    const Vec3<Lanes> u = direction_random(path, s, random, bounce.number);
    const PathLanes here = path;  // only a copy has an address: the path itself stays in registers
    const ThinWallHit hit{.scatters = scatters,
                          .any_layers = s.any_layers,
                          .only_passes = bounce.is_over,
                          .distance = group.hit.t,
                          .choice = u.z,
                          .wo = to_local(s.frame, -path.direction),
                          .transmitted_start = s.any_layers ? s.transmitted_start : s.start};
    const PassedThinWalls passed = pass_thin_walls(columns, at, here, hit, s.layers);
    random.bsdf.x = random.bsdf.x * passed.left;
    return passed;
}

/// Changes the lobes of the paths that have scattered roughly.
///
/// In      change: regularize or remove_smooth_lobes
OBSCURA_INLINE void change_lobes(const PathLanes& path,
                                 void (*change)(RoughPathHit&, LayeredPoint*),
                                 ShadingPoint& s) {
    const Mask rough = (path.medium_stack & LanesU(scattered_roughly)) != LanesU(0U);
    if (none(rough)) return;
    // A copy: else all of `s` would have an address, and live in memory.
    RoughPathHit hit{rough, to_local(s.frame, -path.direction), s.bsdf, s.lobes};
    change(hit, s.any_layers ? &s.layers : nullptr);
    s.bsdf = hit.bsdf;
    s.lobes = hit.lobes;
}

}  // namespace

ShadeCounts shade(const SceneView& scene,
                  const BatchSettings& batch,
                  int number,
                  int count_in,
                  const ShadeColumns& columns) {
    const Bounce bounce = begin_bounce(scene, batch, number, columns);
    if (number == 0) set_camera_alpha(batch, count_in, columns);
    const SortedCounts sorted = sort_paths(bounce, count_in, columns);
    shade_misses(scene, batch, number, sorted.misses, columns);
    LightDraw draws[groups_ahead];
    ShadeCounts out;
    for (int i = 0; i < sorted.hits; i += lane_count) {
        const int k = i / lane_count % groups_ahead;
        if (k == 0) {
            const int groups = (sorted.hits - i + lane_count - 1) / lane_count;
            draw_ahead(bounce, columns.paths, i, min(groups, groups_ahead), draws);
        }
        const Mask exists = lanes_in_range(i, sorted.hits);
        PathLanes path = load_paths(columns.paths, i);
        const HitLanes hit = hits_of_paths(columns, i, exists, path);
        if (scene.media != nullptr) absorb(scene, exists, hit.t, path);
        BounceRandom random = bounce_random(path, number);
        ShadingPoint s = shading_point(
            scene, hit, path, {Filtering::stochastic, random.texture, batch.footprint_fraction});
        if (batch.regularize) change_lobes(path, regularize, s);
        const ShadedGroup group{path, s, random, draws[k], hit};
        add_emission(bounce, columns, exists, group);
        Mask scatters = exists & (!s.unlit);
        Mask turns = scatters;
        if (columns.distance_since_scattering != nullptr) {
            const PassedThinWalls passed =
                add_straight_rays(columns, out.next, scatters, group, bounce);
            out.next = passed.next;
            turns = passed.others;
        }
        if (s.any_layers) {
            const Mask unseen = scatters & is_passed_unseen(s.layers.boundary);
            out.next =
                add_passing_rays(columns.next, out.next, bounce.is_over ? unseen : scatters, group);
        }
        if (bounce.is_over || none(scatters)) continue;
        if (!batch.caustics) change_lobes(path, remove_smooth_lobes, s);
        if (s.any_layers) {
            const Mask hidden = s.layers.layered & s.layers.boundary.hidden;
            scatters = scatters & (!hidden);
            turns = turns & (!hidden);
        }
        if (scene.occludes) store_by_slot(columns.occlusion, turns, path.slot, s.occlusion);
        choose_by_tree(scene, columns, turns, scatters, group);
        // Before the paths turn: light layers split the shadow rays' light by where the paths were.
        if (scene.lights.count > 0) {
            out.shadow = add_shadow_rays(bounce, columns, out.shadow, scatters, group);
        }
        out.next = add_next_rays(bounce, columns.next, out.next, turns, group);
    }
    return out;
}

int shade_ao(const SceneView& scene,
             const BatchSettings& batch,
             int count_in,
             const ShadeColumns& columns) {
    set_camera_alpha(batch, count_in, columns);
    const SortedCounts sorted = sort_hits_from_misses(count_in, columns);
    int shadows = 0;
    for (int i = 0; i < sorted.hits; i += lane_count) {
        const Mask exists = lanes_in_range(i, sorted.hits);
        const PathLanes path = load_paths(columns.paths, i);
        const HitLanes hit = hits_of_paths(columns, i, exists, path);
        const BounceRandom random = bounce_random(path, 0);
        const ShadingPoint s = shading_point(
            scene, hit, path, {Filtering::stochastic, random.texture, batch.footprint_fraction});
        const Vec3<Lanes> direction = normalize(to_world(s.frame, cosine_hemisphere(random.bsdf)));
        const Mask useful = exists & (dot(direction, s.ng) > Lanes(0.0f));
        shadows = append_shadows(columns.shadows,
                                 shadows,
                                 useful,
                                 {.origin = s.start,
                                  .direction = direction,
                                  .tfar = Lanes(batch.ao_distance),
                                  .radiance = splat3(Lanes(1.0f)),
                                  .slot = path.slot,
                                  .path_key = path.path_key});
    }
    return shadows;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
