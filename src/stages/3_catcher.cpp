// stages/3_catcher.cpp - stage 3 at shadow catchers, white Lambert surfaces that receive light.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_catcher.h"

#include "math/sampler.h"
#include "stages/3_lights.h"
#include "surface/fresnel.h"
#include "surface/ggx.h"
#include "surface/lobes/diffuse.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// The density of next rays, far below any of light sampling: by MIS they count where light
/// sampling finds nothing.
constexpr float density_below_all = 1e-30f;

constexpr float catcher_f0 = 0.04f;

/// Where a path from the camera meets a catcher. Normals are on the viewer's side.
struct CatcherPoint {
    Vec3<Lanes> start;        ///< of rays, clear of the surface
    Vec3<Lanes> light_start;  ///< of rays to lights, see ShadingPoint
    Vec3<Lanes> ng;
    Vec3<Lanes> normal;  ///< interpolated, without normal map
    Lanes distance;
    Lanes time;
};

/// One group of paths at their catchers.
struct CatcherGroup {
    Mask exists;
    const PathLanes& path;
    const CatcherPoint& point;
    int bounce;
};

OBSCURA_INLINE CatcherPoint catcher_point(const SceneView& scene,
                                          const CatcherColumns& columns,
                                          int i,
                                          Mask exists,
                                          const PathLanes& path) {
    const Vec3<Lanes> up{Lanes(0.0f), Lanes(1.0f), Lanes(0.0f)};
    const Lanes distance = load(columns.hits.t + i);
    Vec3<Lanes> met = path.origin + path.direction * distance;
    // Glass that stands on the ground lets rays out below it, clear of the glass.
    met.y = min(Lanes(columns.ground_m), path.origin.y);
    CatcherPoint out{met, met, up, up, distance, Lanes(0.0f)};
    if (columns.time != nullptr) {
        out.time = gather<Lanes>(columns.time, select(exists, as_int(path.slot), LanesI(0)));
    }
    const Mask surface = exists & (load(columns.hits.primitive + i) >= LanesI(0));
    if (none(surface)) return out;
    HitLanes hit = hits_or_first(columns.hits, i, surface);
    hit.time = out.time;
    const SurfaceInteraction found = find_surface_interaction<HitUse::start_rays>(
        scene, hit, path, {Filtering::bilinear, splat3(Lanes(0.5f))});
    const HitGeometry& g = found.g;
    const Mask front = surface & (found.cos_front >= Lanes(0.0f));
    const Vec3<Lanes> start = g.position + found.ng * g.offset;
    const Vec3<Lanes> smooth = select(dot(g.normal, found.ng) < Lanes(0.0f), -g.normal, g.normal);
    out.start = select(surface, start, out.start);
    out.light_start = select(surface, start, out.light_start);
    out.light_start = select(front, out.light_start + g.smooth_shift, out.light_start);
    out.ng = select(surface, found.ng, out.ng);
    out.normal = select(surface, smooth, out.normal);
    return out;
}

OBSCURA_INLINE Vec2<LanesU> random_pair(const CatcherGroup& group, RandomUse use) {
    const uint32_t number =
        static_cast<uint32_t>(group.bounce) * pairs_per_bounce + static_cast<uint32_t>(use);
    return sobol_pair(group.path.key, group.path.sample, number);
}

/// One light and a point on it, by the random numbers that a surface uses there.
OBSCURA_INLINE LightLanes sampled_light(const SceneView& scene, const CatcherGroup& group) {
    const CatcherPoint& point = group.point;
    LightDraw draw = draw_light(scene, random_pair(group, RandomUse::light));
    draw_light_pixel(scene, draw);
    if (scene.lights.tree.nodes != nullptr)
        draw_light_of_tree(scene, {point.light_start, point.normal}, group.exists, draw);
    const Vec2<LanesU> bits = random_pair(group, RandomUse::texture);
    const Vec2<Lanes> texel = unit_pair<Lanes>(bits);
    const Vec3<Lanes> texture{
        texel.x, texel.y, unit_float<Lanes>((bits.y << 16) | (bits.x & LanesU(0xFFFFU)))};
    ShadingPoint s;
    s.light_start = point.light_start;
    s.time = point.time;
    return sample_light(scene, s, draw, texture);
}

OBSCURA_INLINE int add_shadow_rays(const ShadowColumns& columns,
                                   int at,
                                   const CatcherGroup& group,
                                   const LightLanes& light) {
    const auto& [exists, path, point, bounce] = group;
    const Lanes cosine = dot(point.normal, light.direction);
    const Vec3<Lanes> radiance =
        path.throughput * light.radiance_over_pdf * (cosine * Lanes(1.0f / pi_f));
    const Mask useful = exists & light.valid & (cosine > Lanes(0.0f)) &
                        (dot(point.ng, light.direction) > Lanes(0.0f)) &
                        (max_component(radiance) > Lanes(0.0f));
    return append_shadows(columns,
                          at,
                          useful,
                          {.origin = point.light_start,
                           .direction = light.direction,
                           .tfar = light.distance,
                           .radiance = radiance,
                           .slot = path.slot,
                           .path_key = path.path_key});
}

/// A ray that goes on from a catcher, without its direction, throughput, density and spread.
OBSCURA_INLINE PathLanes leaving(const PathLanes& path, const CatcherPoint& point) {
    PathLanes next = path;
    next.origin = point.start;
    next.medium_stack = path.medium_stack | LanesU(seen_unclearly);
    next.cone_width = path.cone_width + path.cone_spread * point.distance;
    return next;
}

OBSCURA_INLINE int add_next_rays(const PathColumns& columns, int at, const CatcherGroup& group) {
    const auto& [exists, path, point, bounce] = group;
    const Vec2<Lanes> u = unit_pair<Lanes>(random_pair(group, RandomUse::bsdf));
    PathLanes next = leaving(path, point);
    next.direction = normalize(to_world(frame_around(point.normal), cosine_hemisphere(u)));
    next.pdf = Lanes(density_below_all);
    next.cone_spread = path.cone_spread + Lanes(diffuse_spread);
    return append_paths(columns, at, exists & (dot(next.direction, point.ng) > Lanes(0.0f)), next);
}

/// Rays off the gloss: facets seen from the viewer, so that their density cancels.
OBSCURA_INLINE int add_reflections(const PathColumns& columns, int at, const CatcherGroup& group) {
    const auto& [exists, path, point, bounce] = group;
    constexpr float alpha = catcher_roughness * catcher_roughness;
    const GgxWidths<Lanes> widths{Lanes(alpha), Lanes(alpha)};
    const Frame<Lanes> frame = frame_around(point.normal);
    Vec3<Lanes> wo = to_local(frame, -path.direction);
    wo.z = max(wo.z, Lanes(1e-4f));
    const Vec2<Lanes> u = unit_pair<Lanes>(random_pair(group, RandomUse::roulette));
    const Vec3<Lanes> facet = sample_visible_normal(wo, widths, u);
    const Lanes cosine = dot(wo, facet);
    const Vec3<Lanes> wi = facet * (Lanes(2.0f) * cosine) - wo;
    const Lanes fresnel = Lanes(catcher_f0) + Lanes(1.0f - catcher_f0) * schlick_weight(cosine);
    const Lanes shadowing =
        smith_shadowing(wo.z, smith_length(wo, widths), wi.z, smith_length(wi, widths));
    PathLanes next = leaving(path, point);
    next.direction = normalize(to_world(frame, wi));
    next.throughput = path.throughput * (fresnel * shadowing);
    next.pdf = Lanes(0.0f);  // no light is sampled for the gloss: its rays bring all
    next.cone_spread = path.cone_spread + Lanes(alpha);
    const Mask leaves =
        exists & (wi.z > Lanes(0.0f)) & (dot(next.direction, point.ng) > Lanes(0.0f));
    return append_paths(columns, at, leaves, next);
}

}  // namespace

CatcherCounts shade_catchers(const SceneView& scene, int count, const CatcherColumns& columns) {
    CatcherCounts out{columns.first_next, 0, columns.first_reflection};
    for (int i = 0; i < count; i += lane_count) {
        const Mask exists = lanes_in_range(i, count);
        const PathLanes path = load_paths(columns.paths, i);
        const CatcherPoint point = catcher_point(scene, columns, i, exists, path);
        const CatcherGroup group{exists, path, point, columns.bounce};
        if (columns.lit_points != nullptr) {
            note_lit_points(
                columns.lit_points, exists, path.slot, {point.light_start, point.normal});
        }
        if (scene.lights.count > 0) {
            const LightLanes light = sampled_light(scene, group);
            out.shadow = add_shadow_rays(columns.shadows, out.shadow, group, light);
        }
        out.next = add_next_rays(columns.next, out.next, group);
        if (columns.reflects) {
            out.reflections = add_reflections(columns.reflections, out.reflections, group);
        }
    }
    return out;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
