// stages/3_raycast.cpp - stage 3 for --integrator raycast: every light, once, without randomness.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_misses.h"
#include "stages/3_scatter.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// Unshadowed environment light: irradiance by the normal for the diffuse part, radiance around the
/// mirror direction for the specular part.
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
    const SpecularAlbedo<Lanes> once = specular_albedo(cosine, p.alpha);
    return p.base_color * s.lobes.diffuse * diffuse +
           (s.lobes.specular_f0 * once.mirror + s.lobes.specular_rise * once.grazing) * specular;
}

/// Fraction of uniform light that sheen passes on to the layers below: evaluate_layered's factor
/// for this view direction, averaged over cosine-distributed light directions.
OBSCURA_INLINE Lanes left_by_sheen(const LayeredParams<Lanes>& p, const LayeredWeights<Lanes>& w) {
    const Lanes max_sheen = max_component(p.sheen_color);
    if (none(max_sheen > Lanes(0.0f))) return Lanes(1.0f);
    constexpr int strata = 4;
    Lanes sum(0.0f);
    for (int i = 0; i < strata; ++i) {
        const Lanes cosine = sqrt(Lanes((static_cast<float>(i) + 0.5f) / strata));
        const Lanes below = Lanes(1.0f) - max_sheen * sheen_albedo(cosine, p.sheen_alpha).albedo;
        sum = sum + min(w.below_sheen, below);
    }
    return sum * Lanes(1.0f / strata);
}

/// The same for a material with layers: every lobe reflects the light around its own main direction
/// by its directional albedo, and transmitted light comes from straight behind.
OBSCURA_INLINE Vec3<Lanes> ambient_layers(const AmbientLight& light,
                                          const ShadingPoint& s,
                                          const Vec3<Lanes>& wo) {
    const LayeredParams<Lanes>& p = s.layers.params;
    const LayeredWeights<Lanes>& w = s.layers.weights;
    const Lanes one(1.0f);
    const auto from = [&](const Vec3<Lanes>& direction) {
        return ambient_irradiance(light, direction) * Lanes(1.0f / pi_f);
    };
    const auto mirrored = [&](const Vec3<Lanes>& n) {
        return from(n * (Lanes(2.0f) * dot(n, wo)) - wo);
    };
    const Vec3<Lanes>& n = s.frame.normal;
    const Lanes cosine = dot(n, wo);
    const FacetWeights<Lanes> facets = facet_weights(p, to_local(s.frame, wo));
    const auto albedo = [&](const Vec3<Lanes>& f0, Lanes f90, const Vec3<Lanes>& with_thin_film) {
        const Vec3<Lanes> plain =
            f0 * (facets.once.mirror - facets.once.grazing) + splat3(f90 * facets.once.grazing);
        return plain + (with_thin_film * facets.once.mirror - plain) * p.thin_film.strength;
    };
    const Vec3<Lanes> dielectric = albedo(p.f0, p.f90, facets.fresnel.dielectric);
    const Vec3<Lanes> metal = albedo(p.base_color, one, facets.fresnel.metal);
    const Vec3<Lanes> front = from(n);
    Vec3<Lanes> sum = facet_reflectance(w, {dielectric, metal}) * mirrored(n);
    sum = sum + p.base_color * front * (w.diffuse * (one - p.diffuse_transmission));
    if (any(s.layers.lets_through)) {
        const Lanes passes = w.transmitted * select(p.solid, one - facets.boundary, one);
        sum = sum + p.base_color * from(-wo) * passes;
        sum = sum + p.diffuse_transmission_color * from(-n) * (w.diffuse * p.diffuse_transmission);
    }
    const Lanes sheen = sheen_albedo(cosine, p.sheen_alpha).albedo;
    sum = sum * left_by_sheen(p, w) + p.sheen_color * front * sheen;
    if (none(p.coat > Lanes(0.0f))) return sum;
    const Vec3<Lanes> coat_normal = to_world(s.frame, p.coat_normal);
    return sum * w.below_coat + mirrored(coat_normal) * (one - w.below_coat);
}

/// Adds the light that needs no shadow ray: emission, unlit colours, environment, headlight.
OBSCURA_INLINE void add_unshadowed(const SceneView& scene,
                                   const SampleColumns& samples,
                                   Mask exists,
                                   const PathLanes& path,
                                   const ShadingPoint& s) {
    const Vec3<Lanes> wo = -path.direction;
    Vec3<Lanes> light = s.emission;
    if (scene.raycast.ambient != nullptr) {
        Vec3<Lanes> around = ambient_light(*scene.raycast.ambient, s, wo);
        if (s.any_layers) {
            const Vec3<Lanes> all = ambient_layers(*scene.raycast.ambient, s, wo);
            around = select(s.layers.layered, all, around);
        }
        if (scene.occludes) around = around * s.occlusion;
        light = light + around;
    }
    if (scene.raycast.headlight) {
        const Vec3<Lanes> local = to_local(s.frame, wo);
        light = light + evaluate_point(s, local, local).value_cos * Lanes(headlight_irradiance);
    }
    light = select(s.unlit, s.emission + s.bsdf.base_color, light);
    // The mask is computed anew: GCC 12 reloads one spilled earlier with wrong high bits.
    const Mask glows = exists & !(max_component(light) <= Lanes(0.0f));
    if (any(glows)) add_radiance(samples, glows, path.slot, path.throughput * light);
}

}  // namespace

int begin_raycast(const SceneView& scene,
                  const BatchSettings& batch,
                  int count,
                  const ShadeColumns& columns) {
    set_camera_alpha(batch, count, columns);
    const SortedCounts sorted = sort_hits_from_misses(count, columns);
    shade_misses(scene, batch, 0, sorted.misses, columns);
    return sorted.hits;
}

int shade_raycast(const SceneView& scene,
                  const RaycastRange& range,
                  const RaycastColumns& columns) {
    const int end = range.first_hit + range.hits;
    int shadows = 0;
    for (int i = range.first_hit; i < end; i += lane_count) {
        const Mask exists = lanes_in_range(i, end);
        PathLanes path = load_paths(columns.paths, i);
        path.key = LanesU(d_line_key);  // pixels must not differ in their wavelengths
        path.sample = LanesU(0U);
        const HitLanes hit = hits_of_paths(columns, i, exists, path);
        const ShadingPoint s =
            shading_point(scene, hit, path, {Filtering::bilinear, splat3(Lanes(0.5f))});
        if (range.first_light == 0) add_unshadowed(scene, columns.samples, exists, path, s);
        const Vec3<Lanes> wo = to_local(s.frame, -path.direction);
        for (int k = range.first_light; k < range.first_light + range.lights; ++k) {
            const int centre = k - scene.lights.punctual_count;
            const auto light_from = [&](const Vec3<Lanes>& from) {
                return centre < 0
                           ? sample_punctual<Lanes>(
                                 scene.lights.punctual, LanesI(k), from, scene.lights.profiles)
                           : sample_centre_light<Lanes>(scene.raycast.centres, centre, from);
            };
            Vec3<Lanes> start = s.light_start;
            PunctualSample<Lanes> light = light_from(start);
            if (s.any_layers) {  // what comes through the surface comes from the other side
                const Mask in_front = dot(light.direction, s.ng) > Lanes(0.0f);
                start = select(in_front, start, s.transmitted_start);
                light = light_from(start);
            }
            const Vec3<Lanes> wi = to_local(s.frame, light.direction);
            const Vec3<Lanes> radiance =
                path.throughput * light.irradiance * evaluate_point(s, wo, wi).value_cos;
            const Mask reflected_side = dot(light.direction, s.ng) > Lanes(0.0f);
            const Mask useful = exists & (!s.unlit) & may_leave(s, reflected_side, wi) &
                                (max_component(radiance) > Lanes(0.0f));
            if (none(useful)) continue;
            shadows = append_shadows(columns.shadows,
                                     shadows,
                                     useful,
                                     {.origin = start,
                                      .direction = light.direction,
                                      .tfar = light.distance,
                                      .radiance = radiance,
                                      .slot = path.slot,
                                      .path_key = path.path_key});
        }
    }
    return shadows;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
