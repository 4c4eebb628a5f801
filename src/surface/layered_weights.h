// surface/layered_weights.h - how the layers of a material share the light that arrives.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/glass_albedo.h"
#include "surface/layered_params.h"
#include "surface/sheen.h"
#include "surface/stretched_albedo.h"

namespace obscura {
inline namespace OBSCURA_ISA {

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
    F factor;                       ///< of its facets: interreflection
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
    const auto from_within =
        p.solid & (p.eta < one) & ((one - p.metallic) * (one - p.transmission) > F(0.0f));
    if (any(from_within)) {
        s.boundary = select(from_within, inner_boundary_albedo(p, wo), s.boundary);
        // Over all angles as much light goes out as comes in, by the squared indices.
        mean = select(from_within, one - (one - mean) * p.eta * p.eta, mean);
    }
    s.factor = interreflection(s.once.mirror, mean);
    s.boundary = min(s.boundary * s.factor, one);
    const Vec3<F> mean_metal = mean_schlick(p.base_color);
    s.metal_factor = interreflection(
        s.once.mirror, mean_metal + (s.fresnel.metal - mean_metal) * p.thin_film.strength);
    return s;
}

/// Width of what a thin wall lets through, as a share of its facets' width: the less it refracts,
/// the less it blurs, and nothing at an index of 1. From 1.5 on as it reflects.
template <typename F>
OBSCURA_INLINE F thin_wall_spread(const F& ior) {
    return square(clamp(F(2.0f) * abs(ior - F(1.0f)), F(0.0f), F(1.0f)));
}

/// What the facets of a dielectric's boundary gain by further bounces, reflecting and refracting.
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

    // What a wall does not reflect passes; a thin-film's facets are not known one by one.
    const F passes = one - s.boundary;
    const F passes_once = max(s.once.mirror - s.boundary / s.factor, F(0.02f));
    F factor = lerp(passes / passes_once, one / s.once.mirror, p.thin_film.strength);
    if (any(!w.facetwise)) {
        F mirror = stretched_albedo(wo, w.through_alpha).mirror;
        mirror = select(is_smooth(w.through_alpha), one, mirror);
        factor = select(w.facetwise, factor, passes / mirror);
    }
    if (any(p.solid)) {
        const F glass = glass_factor(p, wo);
        factor = select(p.solid, glass, factor);
        const F clear = select(p.solid, (one - p.metallic) * glass, w.dielectric);
        w.dielectric = lerp(w.dielectric, clear, p.transmission);
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

/// Sets the probabilities of the lobes.
template <typename F>
OBSCURA_INLINE void choose_lobes(const LayeredParams<F>& p,
                                 const FacetWeights<F>& s,
                                 const F& sheen_albedo,
                                 LayeredWeights<F>& w) {
    const F zero(0.0f);
    const F one(1.0f);
    const F color = luminance(p.base_color);
    const F reflected = luminance(s.fresnel.dielectric);
    const F below = w.below_coat * w.below_sheen;
    const F dielectric = one - p.metallic;
    const F coat_weight = one - w.below_coat;
    const F specular =
        below * (dielectric * max(s.boundary, reflected) + p.metallic * luminance(s.fresnel.metal));
    const F diffuse = below * w.diffuse * (one - p.diffuse_transmission) * color +
                      w.below_coat * luminance(p.sheen_color) * sheen_albedo;
    const F diffuse_transmitted =
        below * w.diffuse * p.diffuse_transmission * luminance(p.diffuse_transmission_color);
    const F passes = select(p.solid, w.transmitted * (one - reflected), w.transmitted);
    const F transmitted = below * passes * color;
    // What exists is tried now and then, for other directions than the mirrored one.
    const F facet = specular + transmitted;
    const F sum = max(facet + diffuse + diffuse_transmitted + coat_weight, F(1e-6f));
    const auto at_least = [&](const F& share, const MaskOf<F>& exists) {
        return select(exists, max(share / sum, F(0.05f)), F(0.0f));
    };
    const F nothing(1e-7f);  // rounding of what other layers take
    w.p_diffuse = at_least(diffuse, diffuse > nothing);
    w.p_facet = at_least(facet, (specular > zero) | (w.transmitted * color > zero));
    w.p_coat = at_least(coat_weight, p.coat > zero);
    w.p_diffuse_transmission = at_least(diffuse_transmitted, diffuse_transmitted > nothing);
    const F total = w.p_diffuse + w.p_facet + w.p_coat + w.p_diffuse_transmission;
    const F scale = one / max(total, F(1e-6f));
    w.p_diffuse = w.p_diffuse * scale;
    w.p_facet = w.p_facet * scale;
    w.p_coat = w.p_coat * scale;
    w.p_diffuse_transmission = w.p_diffuse_transmission * scale;
}

/// Shares and probabilities for one view direction, wo.z > 0.
template <typename F>
OBSCURA_INLINE LayeredWeights<F> layered_weights(const LayeredParams<F>& p, const Vec3<F>& wo) {
    const F one(1.0f);
    const F zero(0.0f);
    LayeredWeights<F> w;
    w.below_coat = one;
    w.coat_factor = one;
    if (any(p.coat > zero)) {
        const F cosine = dot(wo, p.coat_normal);
        const DielectricLobe<F> coat = dielectric_lobe(specular_albedo(cosine, p.coat_alpha));
        w.below_coat = one - p.coat * coat.albedo;
        w.coat_factor = coat.factor;
    }
    SheenAlbedo<F> sheen{zero, one};
    const F max_sheen = max_component(p.sheen_color);
    if (any(max_sheen > zero)) sheen = sheen_albedo(wo.z, p.sheen_alpha);
    w.sheen_scale = sheen.scale;
    w.below_sheen = one - max_sheen * sheen.albedo;

    const FacetWeights<F> shares = facet_weights(p, wo);
    const F dielectric = one - p.metallic;
    w.diffuse = dielectric * (one - p.transmission) * (one - shares.boundary);
    w.dielectric = dielectric * shares.factor;
    w.metal = shares.metal_factor * p.metallic;
    split_transmission(p, shares, wo, w);
    choose_lobes(p, shares, sheen.albedo, w);
    return w;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
