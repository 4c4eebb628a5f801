// stages/3_raycast.cpp - stage 3 for --integrator raycast: every light, once, without randomness.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_misses.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// Light from the environment without shadows: by the normal into the diffuse part, and from around
/// the mirrored direction into the specular one.
OBSCURA_INLINE Vec3<Lanes> ambient_light(const AmbientLight& light,
                                         const ShadingPoint& s,
                                         const Vec3<Lanes>& wo) {
    const BsdfParams<Lanes>& p = s.bsdf;
    const Vec3<Lanes>& n = s.frame.normal;
    const Lanes cosine = dot(n, wo);
    const Vec3<Lanes> mirrored = n * (Lanes(2.0f) * cosine) - wo;
    const Lanes inverse_pi(1.0f / pi_f);
    const Vec3<Lanes> diffuse = ambient_irradiance(light, n) * inverse_pi;
    const Vec3<Lanes> specular = ambient_irradiance(light, mirrored) * inverse_pi;
    const auto albedo = [&](Lanes f0) { return specular_albedo(f0, cosine, p.alpha); };
    const Vec3<Lanes> metal{albedo(p.base_color.x), albedo(p.base_color.y), albedo(p.base_color.z)};
    const Lanes dielectric = (Lanes(1.0f) - p.metallic) * albedo(Lanes(dielectric_f0));
    return p.base_color * s.lobes.diffuse * diffuse +
           (metal * p.metallic + splat3(dielectric)) * specular;
}

/// What needs no shadow ray: emission, unlit colours, the environment, the headlight.
OBSCURA_INLINE void add_unshadowed(const SceneView& scene,
                                   const SampleRows& samples,
                                   Mask exists,
                                   const PathLanes& path,
                                   const ShadingPoint& s) {
    const Vec3<Lanes> wo = -path.direction;
    Vec3<Lanes> light = s.emission;
    if (scene.raycast.ambient != nullptr) {
        light = light + ambient_light(*scene.raycast.ambient, s, wo);
    }
    if (scene.raycast.headlight) {
        const Vec3<Lanes> local = to_local(s.frame, wo);
        light = light + evaluate_bsdf(s.bsdf, s.lobes, local, local).value_cos *
                            Lanes(headlight_irradiance);
    }
    light = select(s.unlit, s.bsdf.base_color, light);
    // A mask made here: GCC 12 reads one kept from before this many registers with wrong high bits.
    const Mask glows = exists & !(max_component(light) <= Lanes(0.0f));
    if (any(glows)) add_radiance(samples, glows, path.slot, path.throughput * light);
}

}  // namespace

int begin_raycast(const SceneView& scene,
                  const BatchSettings& batch,
                  int count,
                  const ShadeRows& rows) {
    const SortedCounts sorted = sort_hits_from_misses(count, rows);
    set_camera_alpha(batch, sorted, rows);
    shade_misses(scene, batch, 0, sorted.misses, rows);
    return sorted.hits;
}

int shade_raycast(const SceneView& scene, const RaycastRange& range, const ShadeRows& rows) {
    const int end = range.first_hit + range.hits;
    int shadows = 0;
    for (int i = range.first_hit; i < end; i += lane_count) {
        const Mask exists = rows_in_range(i, end);
        const PathLanes path = load_paths(rows.paths, i);
        const HitLanes hit = hits_of_paths(rows, i, exists, path);
        const ShadingPoint s =
            shading_point(scene, hit, path, splat3(Lanes(0.5f)), Filtering::bilinear);
        if (range.first_light == 0) add_unshadowed(scene, rows.samples, exists, path, s);
        const Vec3<Lanes> wo = to_local(s.frame, -path.direction);
        for (int k = range.first_light; k < range.first_light + range.lights; ++k) {
            const int centre = k - scene.lights.punctual_count;
            const PunctualSample<Lanes> light =
                centre < 0
                    ? sample_punctual<Lanes>(
                          scene.lights.punctual, LanesI(k), s.light_start, scene.lights.profiles)
                    : sample_centre_light<Lanes>(scene.raycast.centres, centre, s.light_start);
            const Vec3<Lanes> wi = to_local(s.frame, light.direction);
            const Vec3<Lanes> radiance = path.throughput * light.irradiance *
                                         evaluate_bsdf(s.bsdf, s.lobes, wo, wi).value_cos;
            const Mask useful = exists & (!s.unlit) & (dot(light.direction, s.ng) > Lanes(0.0f)) &
                                (max_component(radiance) > Lanes(0.0f));
            if (none(useful)) continue;
            shadows = append_shadows(rows.shadows,
                                     shadows,
                                     useful,
                                     {s.light_start,
                                      light.direction,
                                      light.distance,
                                      radiance,
                                      path.slot,
                                      path.path_key});
        }
    }
    return shadows;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
