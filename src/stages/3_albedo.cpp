// stages/3_albedo.cpp - stage 3 for the AOV `albedo`: of the first rough surface on each path.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_albedo.h"

#include "surface/surface_albedo.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// Scattering of the dominant media in which lanes of `exist` travel.
struct InsideLanes {
    Vec3<Lanes> reflectance;  ///< of a deep medium; 1 where nothing scatters
    Mask scatters;
};

OBSCURA_INLINE InsideLanes look_inside(const SceneView& scene, Mask exist, LanesU medium_stack) {
    const Vec3<Lanes> white = splat3(Lanes(1.0f));
    const LanesI medium = select(exist, dominant_medium(medium_stack), LanesI(0));
    const Four<Lanes> scattering = read_scattering(scene, medium);
    const Mask scatters_here = exist & scatters(scattering);
    const Vec3<Lanes> deep{medium_reflectance(scattering.x, scattering.w),
                           medium_reflectance(scattering.y, scattering.w),
                           medium_reflectance(scattering.z, scattering.w)};
    return {select(scatters_here, deep, white), scatters_here};
}

/// What albedo_at gets.
struct AlbedoQuery {
    const SceneView& scene;
    const HitLanes& hit;
    const PathLanes& path;
    const SurfaceInteraction& interaction;
};

/// Replaces the albedo of the lanes that have layers.
void add_layers(const AlbedoQuery& query, const BsdfParams<Lanes>& base, HitAlbedo& out) {
    const auto& [scene, hit, path, interaction] = query;
    const HitGeometry& g = interaction.g;
    const Mask layered = g.material.integer<&Material::layers>() >= LanesI(0);
    if (none(layered)) return;
    // An albedo has no direction: the surface lies as its own coordinates do.
    const Lanes zero(0.0f);
    const Lanes one(1.0f);
    const Vec3<Lanes> x{one, zero, zero}, y{zero, one, zero}, z{zero, zero, one};
    const LanesI tangent_base = g.primitive.integer<&Primitive::tangent_base>();
    const TangentLanes tangents{layered & (tangent_base != LanesI(no_attribute)), x, y};
    const Mask front = interaction.cos_front >= zero;
    LayerContext context{tangents, {x, y, z}, z, z, z, front, layered};
    LayeredPoint point;
    read_layers({scene, g, interaction.filter, path, hit.shared}, base, context, point);
    InsideLanes inside{splat3(Lanes(1.0f)), Mask(false)};
    if (scene.scatters) inside = look_inside(scene, layered, point.boundary.transmitted_stack);
    const SurfaceAlbedo<Lanes> albedo = surface_albedo(point.params, inside.reflectance);
    out.color = select(layered, albedo.all, out.color);
    const Mask clear = (albedo.spread < Lanes(min_spread)) & (!inside.scatters);
    out.passed_on = (layered & (clear | point.boundary.hidden)) | ((!layered) & out.passed_on);
}

/// Moves the paths that are followed, and their hits, to columns of their own. Returns how many.
int pick_followed(int count, const AlbedoColumns& columns) {
    int picked = 0;
    for (int i = 0; i < count; i += lane_count) {
        const Mask exists = lanes_in_range(i, count);
        const LanesI slot = select(exists, as_int(load(columns.paths.slot + i)), LanesI(0));
        const Mask followed = exists & (gather<Lanes>(columns.passed_on, slot) > Lanes(0.0f));
        if (none(followed)) continue;
        append_hits(columns.followed_hits, picked, followed, load_hits(columns.hits, i));
        picked =
            append_paths(columns.followed_paths, picked, followed, load_paths(columns.paths, i));
    }
    return picked;
}

/// What the medium leaves of the light on the way to the hits, as shading will have it.
OBSCURA_INLINE Vec3<Lanes> throughput_at_hits(const SceneView& scene,
                                              Mask hits,
                                              const PathLanes& path,
                                              Lanes distance_m) {
    const Mask inside = hits & (dominant_medium(path.medium_stack) > LanesI(0));
    if (scene.media == nullptr || none(inside)) return path.throughput;
    const LanesU medium_stack = select(inside, path.medium_stack, LanesU(0U));
    return path.throughput * transmittance(scene, medium_stack, distance_m);
}

}  // namespace

HitAlbedo albedo_at(const SceneView& scene,
                    const HitLanes& hit,
                    const PathLanes& path,
                    const SurfaceInteraction& interaction,
                    const CommonTexel& common) {
    const HitGeometry& g = interaction.g;
    const FoundSlots slots = find_slots(scene, g, interaction.filter, common);
    const BsdfParams<Lanes> base = bsdf_params(scene, g, interaction.filter, slots);
    HitAlbedo out{splat3(Lanes(0.0f)), Mask(false)};
    if (!all(g.material.integer<&Material::layers>() >= LanesI(0))) {
        const SurfaceAlbedo<Lanes> core = surface_albedo(base);
        out = {core.all, core.spread < Lanes(min_spread)};
    }
    add_layers({scene, hit, path, interaction}, base, out);
    if (scene.scatters) {  // what scatters on its way is not followed
        const Mask around = look_inside(scene, Mask(true), path.medium_stack).scatters;
        out.passed_on = out.passed_on & (!around);
    }
    const Mask unlit = has_bits<Lanes>(g.material.integer<&Material::flags>(), material_unlit);
    out.color = select(unlit, limit_albedo(base.base_color), out.color);
    out.passed_on = out.passed_on & (!unlit);
    return out;
}

int follow_albedo(const SceneView& scene,
                  const BatchSettings& batch,
                  int bounce,
                  int count,
                  const AlbedoColumns& columns) {
    const bool last = bounce > batch.max_bounces;
    const int followed = pick_followed(count, columns);
    int passed_on = 0;
    for (int i = 0; i < followed; i += lane_count) {
        const Mask exists = lanes_in_range(i, followed);
        const Mask hits = exists & (load(columns.followed_hits.primitive + i) >= LanesI(0));
        const PathLanes path = load_paths(columns.followed_paths, i);
        Vec3<Lanes> albedo = path.throughput;
        Mask goes_on(false);
        if (any(hits)) {
            HitLanes hit = hits_or_first(columns.followed_hits, i, hits);
            hit.shared = columns.shared;
            if (columns.time != nullptr) {
                const LanesI slot = select(exists, as_int(path.slot), LanesI(0));
                hit.time = gather<Lanes>(columns.time, slot);
            }
            const SurfaceInteraction interaction = find_surface_interaction<HitUse::attributes>(
                scene,
                hit,
                path,
                {Filtering::bilinear, splat3(Lanes(0.5f)), batch.footprint_fraction});
            const CommonTexel common = find_common_texel(scene, interaction.g, interaction.filter);
            const HitAlbedo found = albedo_at(scene, hit, path, interaction, common);
            if (!last) goes_on = hits & found.passed_on;
            const Vec3<Lanes> through = throughput_at_hits(scene, hits, path, hit.t);
            albedo = select(hits, through * found.color, albedo);
        }
        const Mask arrives = exists & (!goes_on);
        store_by_slot(columns.albedo.columns[0], arrives, path.slot, albedo.x);
        store_by_slot(columns.albedo.columns[1], arrives, path.slot, albedo.y);
        store_by_slot(columns.albedo.columns[2], arrives, path.slot, albedo.z);
        store_by_slot(columns.passed_on, arrives, path.slot, Lanes(0.0f));
        passed_on += obscura::count(goes_on);
    }
    return passed_on;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
