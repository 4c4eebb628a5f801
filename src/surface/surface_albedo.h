// surface/surface_albedo.h - how much light a material sends back and on, as one colour.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/layered_weights.h"

namespace obscura {

/// The albedo of a material, each channel in [0, 1], and the part of it that is spread widely: by
/// anything but facets as narrow as any (min_ggx_alpha).
template <typename F>
struct SurfaceAlbedo {
    Vec3<F> all;
    F spread;  ///< of the channel that has most
};

/// Surfaces that spread less light than this are mirrors or clear glass: an 8-bit texture misses
/// such a bound by one step at most.
inline constexpr float min_spread = 1.0f / 128;

inline namespace OBSCURA_ISA {

template <typename F>
OBSCURA_INLINE Vec3<F> limit_albedo(const Vec3<F>& albedo) {
    const auto limit = [](const F& x) { return clamp(x, F(0.0f), F(1.0f)); };
    return {limit(albedo.x), limit(albedo.y), limit(albedo.z)};
}

/// The core material, seen along its normal: the diffuse base below the dielectric's reflection,
/// and the base colour of metal, with the light that its facets reflect several times.
///
/// Source  LobeWeights: the sum of what evaluate_bsdf integrates to
template <typename F>
OBSCURA_INLINE SurfaceAlbedo<F> surface_albedo(const BsdfParams<F>& p) {
    const F along(1.0f);
    const LobeWeights<F> w = lobe_weights(p, along);
    const SpecularAlbedo<F> once = specular_albedo(along, p.alpha);
    const Vec3<F> diffuse = p.base_color * w.diffuse;
    const Vec3<F> facets = w.specular_f0 * once.mirror + w.specular_rise * once.grazing;
    const auto narrow = p.alpha <= F(min_ggx_alpha);
    return {limit_albedo(diffuse + facets),
            max_component(select(narrow, diffuse, diffuse + facets))};
}

/// What the facets of the base reflect, seen along the normal.
template <typename F>
struct FacetAlbedo {
    Vec3<F> dielectric;  ///< f0, or a thin film's colour
    Vec3<F> metal;       ///< the base colour, or a thin film's
};

template <typename F>
OBSCURA_INLINE FacetAlbedo<F> facet_albedo(const LayeredParams<F>& p,
                                           const LayeredWeights<F>& w,
                                           const FacetWeights<F>& s) {
    const Vec3<F> grazing = splat3(s.once.grazing);
    const F rise = s.once.mirror - s.once.grazing;
    const auto filmed = [&](const Vec3<F>& plain, const Vec3<F>& film) {
        return plain + (film * s.once.mirror - plain) * p.thin_film.strength;
    };
    const Vec3<F> dielectric = filmed(p.f0 * rise + grazing * p.f90, s.fresnel.dielectric);
    const Vec3<F> metal = filmed(p.base_color * rise + grazing, s.fresnel.metal);
    return {dielectric * w.dielectric, metal * w.metal};
}

/// The less a boundary refracts, the less its roughness shows: this width of its facets is
/// invisible.
///
/// In      eta: index of refraction on the transmitted / the reflected side
template <typename F>
OBSCURA_INLINE F invisible_width(const F& eta) {
    return F(5e-5f) / max(abs(eta - F(1.0f)), F(1e-3f));
}

/// The material with its layers, seen along its normal: sheen and coat, and below them what the
/// facets reflect, the diffuse base reflects and lets through, and the glass lets through. What
/// goes through glass has the base colour, and where the inside scatters light, the colour in
/// which that comes back.
///
/// In      inside: reflectance of what lies behind the surface, 1 where light goes on
/// Errors  none: an estimate, mostly within 0.02; below sheen up to 0.06 too much, since light that
///         leaves at grazing angles loses more to it
/// Source  LayeredWeights: the sum of what evaluate_layered integrates to
template <typename F>
OBSCURA_INLINE SurfaceAlbedo<F> surface_albedo(const LayeredParams<F>& p, const Vec3<F>& inside) {
    const F zero(0.0f);
    const F one(1.0f);
    const Vec3<F> along{zero, zero, one};
    LayeredWeights<F> w;
    const LobeView<F> view = weigh_all(p, along, w);
    const F below_coat = w.below_coat;
    const F below = below_coat * w.below_sheen;

    const Vec3<F> color = p.base_color * (one - p.diffuse_transmission) +
                          p.diffuse_transmission_color * p.diffuse_transmission;
    const Vec3<F> diffuse =
        color * (w.diffuse * below) + p.sheen_color * (Sheen::albedo(w) * below_coat);
    const FacetAlbedo<F> reflected = facet_albedo(p, w, view.facets);
    const F left = one - p.metallic - max_component(reflected.dielectric);
    const F through = select(p.solid, p.transmission * max(left, zero), w.transmitted);
    const Vec3<F> facets =
        (reflected.dielectric + reflected.metal + p.base_color * inside * through) * below;
    const Vec3<F> coat = splat3(one - below_coat);

    const F least(min_ggx_alpha);
    const F invisible = select(p.solid, max(least, invisible_width(p.eta)), least);
    const auto narrow = max(p.alpha.x, p.alpha.y) <= invisible;
    const auto narrow_coat = p.coat_alpha <= least;
    const Vec3<F> spread =
        diffuse + select(narrow, splat3(zero), facets) + select(narrow_coat, splat3(zero), coat);
    return {limit_albedo(diffuse + facets + coat), max_component(spread)};
}

/// Reflectance of a deep medium by the albedo of one scattering.
///
/// In      albedo: of a scattering; g: mean cosine of one, in (-1, 1)
/// Source  van de Hulst, "Multiple Light Scattering", 1980, as Kulla and Conty, "Revisiting
///         Physically Based Shading at Imageworks", SIGGRAPH 2017 course, invert it
template <typename F>
OBSCURA_INLINE F medium_reflectance(const F& albedo, const F& g) {
    const F one(1.0f);
    const F s = sqrt(max(one - albedo, F(0.0f)) / max(one - albedo * g, F(1e-6f)));
    return (one - s) * (one - F(0.139f) * s) / (one + F(1.17f) * s);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
