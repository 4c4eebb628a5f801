// surface/lobes/microfacet.h - the microfacets that reflection and transmission of the base share.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/lobes/lobe.h"
#include "surface/stretched_albedo.h"

namespace obscura {
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

/// Directional albedo of the dielectric boundary as seen from the denser side, where the table for
/// Schlick's curve does not hold: microfacets beyond the critical angle reflect all.
///
/// Errors  none: a mean over fixed microfacets, mostly within 0.01 of the integral, 0.05 at worst
template <typename F>
OBSCURA_INLINE F inner_boundary_albedo(const LayeredParams<F>& p, const Vec3<F>& wo) {
    constexpr int facets = 32;
    constexpr float golden_turn = 0.618034f;  // of the R1 sequence: even around the circle
    const F length_o = smith_length(wo, p.alpha);
    F sum(0.0f);
    for (int n = 0; n < facets; ++n) {
        const float number = static_cast<float>(n) + 0.5f;
        const float turns = number * golden_turn;
        const Vec2<F> u{F(turns - static_cast<float>(static_cast<int>(turns))),
                        F(number / static_cast<float>(facets))};
        const Vec3<F> h = sample_visible_normal(wo, p.alpha, u);
        const F cosine = dot(wo, h);
        const Vec3<F> wi = h * (F(2.0f) * cosine) - wo;
        const F masking =
            smith_shadowing(wo.z, length_o, max(wi.z, F(0.0f)), smith_length(wi, p.alpha));
        const F reflectance = max_component(layered_fresnel(p, cosine).dielectric);
        sum = sum + reflectance * masking;
    }
    return sum * F(1.0f / facets);
}

/// The dielectric boundary and the metal towards one view direction.
template <typename F>
struct FacetWeights {
    LayeredFresnel<F> fresnel;      ///< at wo's own angle
    SpecularAlbedo<F> once;         ///< of all facets
    SpecularAlbedo<F> unstretched;  ///< of round ones with the same area
    F boundary;                     ///< what the dielectric reflects of a white sky
    F factor;                       ///< of its facets in the brightest channel: interreflection
    Vec3<F> dielectric_factor;      ///< the same of each channel
    Vec3<F> metal_factor;
};

/// Whether facets are as narrow as any: they lose nothing, and reflect as a flat surface does.
template <typename F>
OBSCURA_INLINE MaskOf<F> is_smooth(const GgxWidths<F>& alpha) {
    return max(alpha.x, alpha.y) <= F(min_ggx_alpha);
}

template <typename F>
OBSCURA_INLINE FacetWeights<F> facet_weights(const LayeredParams<F>& p, const Vec3<F>& wo) {
    const F one(1.0f);
    FacetWeights<F> s;
    s.fresnel = layered_fresnel(p, wo.z);
    s.unstretched = specular_albedo(wo.z, sqrt(p.alpha.x * p.alpha.y));
    s.once = s.unstretched;
    const auto stretched = p.alpha.x != p.alpha.y;
    if (any(stretched)) {
        const SpecularAlbedo<F> albedo = stretched_albedo(wo, p.alpha);
        s.once.mirror = select(stretched, albedo.mirror, s.once.mirror);
        s.once.grazing = select(stretched, albedo.grazing, s.once.grazing);
    }
    const auto smooth = is_smooth(p.alpha);
    s.once.mirror = select(smooth, one, s.once.mirror);

    const F most = max_component(s.fresnel.dielectric);
    const F max_f0 = max_component(p.f0);
    const F reflected = s.once(max_f0, p.f90);
    s.boundary = lerp(reflected, most * s.once.mirror, p.thin_film.strength);
    s.boundary = select(smooth, most, s.boundary);
    F mean = lerp(mean_schlick(max_f0, p.f90), most, p.thin_film.strength);
    Vec3<F> means{
        mean_schlick(p.f0.x, p.f90), mean_schlick(p.f0.y, p.f90), mean_schlick(p.f0.z, p.f90)};
    means = means + (s.fresnel.dielectric - means) * p.thin_film.strength;
    const auto from_within =
        p.solid & (p.eta < one) & ((one - p.metallic) * (one - p.transmission) > F(0.0f));
    if (any(from_within)) {
        s.boundary = select(from_within, inner_boundary_albedo(p, wo), s.boundary);
        // Over all angles as much light goes out as comes in, by the squared indices.
        const F gathered = p.eta * p.eta;
        mean = select(from_within, one - (one - mean) * gathered, mean);
        const Vec3<F> white = splat3(one);
        means = select(from_within, white - (white - means) * gathered, means);
    }
    s.factor = interreflection(s.once.mirror, mean);
    s.dielectric_factor = interreflection(s.once.mirror, means);
    s.boundary = min(s.boundary * s.factor, one);
    const Vec3<F> mean_metal = mean_schlick(p.base_color);
    s.metal_factor = interreflection(
        s.once.mirror, mean_metal + (s.fresnel.metal - mean_metal) * p.thin_film.strength);
    return s;
}

/// Probability that sample_layered reflects at a microfacet rather than going through it: in the
/// proportion of what the facet leaves of the channels' mean. No channel is more than three times
/// that, so that what microfacets do weighs three times their interreflection at most, once where
/// it has no colour. The same for all facets at thin walls, which blur transmitted light less.
///
/// Source  Walter et al., "Microfacet Models for Refraction", EGSR 2007, sec. 5.3: choosing by the
///         reflectance of the microfacet itself
template <typename F>
OBSCURA_INLINE F facet_reflects(const LayeredParams<F>& p,
                                const LayeredWeights<F>& w,
                                const LayeredFresnel<F>& fresnel) {
    const F passes = F(1.0f) - max_component(fresnel.dielectric);
    const F transmitted = w.through_factor * max(passes, F(0.0f)) * channel_mean(p.base_color);
    const F reflected = channel_mean(facet_reflectance(w, fresnel));
    const F share =
        select(transmitted > F(0.0f), reflected / max(reflected + transmitted, F(1e-20f)), F(1.0f));
    return select(w.facetwise, share, w.reflects);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
