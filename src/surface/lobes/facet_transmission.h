// surface/lobes/facet_transmission.h - microfacet transmission: rough glass and thin walls.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/glass_albedo.h"
#include "surface/lobes/microfacet.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Width of the light through a thin wall, as a fraction of its facets' width: the less it
/// refracts, the less it blurs, and nothing at an index of 1. From 1.5 on as it reflects.
template <typename F>
OBSCURA_INLINE F thin_wall_spread(const F& ior) {
    return square(clamp(F(2.0f) * abs(ior - F(1.0f)), F(0.0f), F(1.0f)));
}

/// The gain of a dielectric's facets by further bounces, reflecting and refracting.
template <typename F>
OBSCURA_INLINE F glass_factor(const LayeredParams<F>& p, const Vec3<F>& wo) {
    // The table is for round facets. Of others the width along the view matters most: what is
    // refracted stays near its plane. The shares are fitted; they leave 2 % at 70 degrees.
    const F x2 = square(p.alpha.x);
    const F y2 = square(p.alpha.y);
    const F along = wo.x * wo.x * lerp(x2, y2, F(0.15f)) + wo.y * wo.y * lerp(y2, x2, F(0.15f)) +
                    wo.z * wo.z * F(0.5f) * (x2 + y2);
    const F specular = min(p.f90 / max(grazing_reflectance(p.eta), F(1e-3f)), F(1.0f));
    const F share = glass_albedo(wo.z, sqrt(sqrt(along)), p.eta, specular);
    return select(is_smooth(p.alpha), F(1.0f), F(1.0f) / share);
}

/// Sets what passes the boundary, and what that does to what it reflects: together they lose
/// nothing.
template <typename F>
OBSCURA_INLINE void split_transmission(const LayeredParams<F>& p,
                                       const FacetWeights<F>& s,
                                       const Vec3<F>& wo,
                                       LayeredWeights<F>& w) {
    const F one(1.0f);
    const F zero(0.0f);
    const F total = (one - p.metallic) * p.transmission;
    w.transmitted = total;
    w.through_factor = zero;
    w.through_alpha = p.alpha;
    w.facetwise = MaskOf<F>(true);
    w.reflects = one;
    if (none(total > zero)) return;
    const F spread = select(p.solid, one, thin_wall_spread(p.eta));
    const F least(min_ggx_alpha);
    w.through_alpha = {max(p.alpha.x * spread, least), max(p.alpha.y * spread, least)};
    w.facetwise = spread >= one;

    // What a thin wall does not reflect passes; a thin film's facets are not known one by one.
    const F passes = one - s.boundary;
    const F passes_once = max(s.once.mirror - s.boundary / s.factor, F(0.02f));
    F factor = lerp(passes / passes_once, one / s.once.mirror, p.thin_film.strength);
    if (any(!w.facetwise)) {
        F mirror = stretched_albedo(wo, w.through_alpha).mirror;
        mirror = select(is_smooth(w.through_alpha), one, mirror);
        factor = select(w.facetwise, factor, passes / mirror);
    }
    if (any(p.solid)) {
        const F dielectric = glass_factor(p, wo);
        factor = select(p.solid, dielectric, factor);
        const Vec3<F> clear =
            select(p.solid, splat3((one - p.metallic) * dielectric), w.dielectric);
        w.dielectric = w.dielectric + (clear - w.dielectric) * p.transmission;
    }
    w.through_factor = total * factor;
    w.transmitted = total * select(p.solid, one, passes);

    const F reflected =
        (one - p.metallic) * s.boundary + p.metallic * channel_mean(s.fresnel.metal);
    const F through = total * passes * channel_mean(p.base_color);
    const F roughness = sqrt(sqrt(p.alpha.x * p.alpha.y));
    // Rough facets differ in what they reflect: none is left out by far.
    const F share = clamp(reflected / max(reflected + through, F(1e-20f)),
                          F(0.1f) * roughness,
                          one - F(0.05f) * roughness);
    w.reflects = select(through > F(1e-6f), share, one);  // not by rounding alone
}

/// The microfacet that sends wo to wi on the transmitted side: half vector and the factor of
/// densities.
template <typename F>
struct TransmittingFacet {
    Vec3<F> h;
    F cosine;    ///< of wo on the microfacet
    F jacobian;  ///< |dot(wo, h)| * d(h) / d(wi), 1/sr
    MaskOf<F> possible;
};

/// Source  Walter et al., "Microfacet Models for Refraction", EGSR 2007, eq. 16, 17; for thin walls
///         a reflection whose result is mirrored through the surface
template <typename F>
OBSCURA_INLINE TransmittingFacet<F> transmitting_facet(const LayeredParams<F>& p,
                                                       const Vec3<F>& wo,
                                                       const Vec3<F>& wi) {
    const Vec3<F> mirrored{wi.x, wi.y, -wi.z};
    const Vec3<F> thin = normalize(wo + mirrored);
    TransmittingFacet<F> c{thin, dot(wo, thin), F(0.25f), wi.z < F(0.0f)};
    if (none(p.solid)) return c;
    Vec3<F> h = normalize(wo + wi * p.eta);
    h = select(h.z < F(0.0f), -h, h);
    const F o = dot(wo, h);
    const F i = dot(wi, h);
    const F denominator = o + p.eta * i;
    const F jacobian = p.eta * p.eta * abs(i) * o / max(denominator * denominator, F(1e-20f));
    c.h = select(p.solid, h, c.h);
    c.cosine = select(p.solid, o, c.cosine);
    c.jacobian = select(p.solid, jacobian, c.jacobian);
    c.possible = c.possible & ((!p.solid) | ((o > F(0.0f)) & (i < F(0.0f))));
    return c;
}

/// Direction through the surface by way of microfacet h; z >= 0 where there is none.
template <typename F>
OBSCURA_INLINE Vec3<F> transmit(const LayeredParams<F>& p, const Vec3<F>& wo, const Vec3<F>& h) {
    const F cosine = dot(wo, h);
    const Vec3<F> mirrored = h * (F(2.0f) * cosine) - wo;
    const Vec3<F> thin{mirrored.x, mirrored.y, -mirrored.z};
    if (none(p.solid)) return thin;
    const F transmitted_cosine = refracted_cosine(cosine, p.eta);
    const Vec3<F> refracted = h * (cosine / p.eta - transmitted_cosine) - wo * (F(1.0f) / p.eta);
    const Vec3<F> solid =
        select(transmitted_cosine < F(0.0f), Vec3<F>{F(0.0f), F(0.0f), F(1.0f)}, refracted);
    return select(p.solid, solid, thin);
}

/// Light through the facets: refracted at the boundary of a solid, its own direction blurred at a
/// thin wall. FacetReflection draws its directions. Radiance is counted per squared index of
/// refraction, which refraction leaves as it is.
///
/// Source  KHR_materials_transmission, _volume, _ior
struct FacetTransmission : Lobe {
    static constexpr LobePlace place = LobePlace::transmitted;
    static constexpr ScatterEvent event{'T', 'G', "transmission"};
    static constexpr bool always_exists = false;
    static constexpr bool is_sampled = false;

    template <typename F>
    struct Params {
        F eta;  ///< index of refraction on the transmitted / the reflected side; a thin wall's own
        MaskOf<F> solid;  ///< what is transmitted is refracted; else the surface is a thin wall
        F transmission;
    };

    template <typename F>
    struct Weights {
        F transmitted;               ///< of the light on a thin wall, or on a solid's dielectric
        F through_factor;            ///< scales the facets that light passes
        GgxWidths<F> through_alpha;  ///< of those facets
        MaskOf<F> facetwise;  ///< each facet shares light by its own reflectance, else all alike
        F reflects;  ///< where all are alike: probability that a path which meets one is reflected
    };

    template <typename F>
    OBSCURA_INLINE static void weigh(const LobeView<F>& view, LayeredWeights<F>& w) {
        split_transmission(view.p, view.facets, view.wo, w);
    }

    template <typename F>
    OBSCURA_INLINE static bool exists(const LayeredParams<F>&, const LayeredWeights<F>& w) {
        return any(w.transmitted > F(0.0f));
    }

    template <typename F>
    OBSCURA_INLINE static MaskOf<F> is_singular(const LayeredParams<F>&,
                                                const LayeredWeights<F>& w) {
        return is_smooth(w.through_alpha);
    }

    template <typename F>
    OBSCURA_INLINE static BsdfValue<F> evaluate(const Transmission<F>& at) {
        const LayeredParams<F>& p = at.p;
        const LayeredWeights<F>& w = at.w;
        const F zero(0.0f);
        const F one(1.0f);
        const TransmittingFacet<F> c = transmitting_facet(p, at.wo, at.wi);
        const LayeredFresnel<F> fresnel = layered_fresnel(p, c.cosine);
        const F passes = select(w.facetwise, one - max_component(fresnel.dielectric), one);
        const F length_o = smith_length(at.wo, w.through_alpha);
        // D G1(wo) / cos_o, of visible normals
        const F density =
            F(2.0f) * ggx_distribution(c.h, w.through_alpha) / (at.wo.z + length_o) * c.jacobian;
        const F shadowing =
            smith_shadowing(at.wo.z, length_o, at.cosine, smith_length(at.wi, w.through_alpha));
        const F through = w.through_factor * passes * density * shadowing;
        const F by_facet = w.p_facet * (one - facet_reflects(p, w, fresnel));
        return {p.base_color * select(c.possible, through, zero),
                select(c.possible, by_facet * density, zero)};
    }
};
}  // namespace OBSCURA_ISA
}  // namespace obscura
