// surface/layered_params.h - the glTF material with its extensions, as its lobes read it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/bsdf.h"

namespace obscura {

/// A surface point's material with all layers, all textures applied, as seen from one side.
template <typename F>
struct LayeredParams {
    Vec3<F> base_color;
    F metallic;
    GgxWidths<F> alpha;  ///< along the shading frame's tangent and bitangent
    Vec3<F> f0;          ///< of the dielectric, at normal incidence
    F f90;               ///< of the dielectric, at grazing incidence
    F eta;  ///< index of refraction on the transmitted / on the viewer's side; a thin wall's own
    MaskOf<F> solid;  ///< what is transmitted is refracted; else the surface is a thin wall
    F transmission;
    F diffuse_transmission;
    Vec3<F> diffuse_transmission_color;
    Vec3<F> sheen_color;
    F sheen_alpha;
    F coat;
    F coat_alpha;
    Vec3<F> coat_normal;  ///< in the shading frame, towards wo
    ThinFilm<F> thin_film;
};

/// What depends on the view direction only: how the layers share the light. The factors of facets
/// hold what light gains that they reflect or refract more than once (interreflection).
template <typename F>
struct LayeredWeights {
    F below_coat, coat_factor;
    F sheen_scale;
    F below_sheen;
    F diffuse;                   ///< what neither reflects at the dielectric boundary nor passes it
    F dielectric;                ///< scales the dielectric's facets, its share included
    Vec3<F> metal;               ///< scales the metal's facets, its share included
    F transmitted;               ///< of the light on a thin wall, of that on a solid dielectric
    F through_factor;            ///< scales the facets that light passes
    GgxWidths<F> through_alpha;  ///< of those facets
    MaskOf<F> facetwise;         ///< each facet shares light by its own reflectance, else all alike
    F reflects;  ///< where all are alike: probability that a path which meets one is reflected
    F p_diffuse, p_facet, p_coat, p_diffuse_transmission;  ///< of sample_layered's lobes, sum 1
};

inline namespace OBSCURA_ISA {

/// Reflectance of the dielectric and the metallic part on a microfacet.
template <typename F>
struct LayeredFresnel {
    Vec3<F> dielectric, metal;
};

template <typename F>
OBSCURA_INLINE LayeredFresnel<F> layered_fresnel(const LayeredParams<F>& p, const F& cosine) {
    const F weight = schlick_weight(cosine);
    F inner = weight;
    F total(0.0f);  // 1: total reflection
    if (any(p.solid)) {
        const F transmitted_cosine = refracted_cosine(cosine, p.eta);
        total = select(p.solid & (transmitted_cosine < F(0.0f)), F(1.0f), F(0.0f));
        const F in_thinner = select(p.eta < F(1.0f), max(transmitted_cosine, F(0.0f)), cosine);
        inner = select(p.solid, schlick_weight(in_thinner), weight);
    }
    LayeredFresnel<F> r;
    r.dielectric = p.f0 + (splat3(p.f90) - p.f0) * inner;
    r.metal = p.base_color + (splat3(F(1.0f)) - p.base_color) * weight;
    if (any(p.thin_film.strength > F(0.0f))) {
        const Vec3<F> over_dielectric = thin_film_reflectance(cosine, p.thin_film, p.f0);
        const Vec3<F> over_metal = thin_film_reflectance(cosine, p.thin_film, p.base_color);
        r.dielectric = r.dielectric + (over_dielectric - r.dielectric) * p.thin_film.strength;
        r.metal = r.metal + (over_metal - r.metal) * p.thin_film.strength;
    }
    r.dielectric = r.dielectric + (splat3(F(1.0f)) - r.dielectric) * total;
    return r;
}

/// What the microfacets leave of the light, dielectric and metal mixed.
template <typename F>
OBSCURA_INLINE Vec3<F> facet_reflectance(const LayeredWeights<F>& w,
                                         const LayeredFresnel<F>& fresnel) {
    return fresnel.dielectric * w.dielectric + fresnel.metal * w.metal;
}

template <typename F>
OBSCURA_INLINE F channel_mean(const Vec3<F>& rgb) {
    return (rgb.x + rgb.y + rgb.z) * F(1.0f / 3);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
