// surface/layered_bsdf.h - the glTF material with its extensions: coat over sheen over the base.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/bsdf.h"
#include "surface/sheen.h"

namespace obscura {

/// A surface point's material with all layers, all textures applied, as seen from one side.
template <typename F>
struct LayeredParams {
    Vec3<F> base_color;
    F metallic;
    GgxWidths<F> alpha;  ///< along the shading frame's tangent and bitangent
    Vec3<F> f0;          ///< of the dielectric, at normal incidence
    F f90;               ///< of the dielectric, at grazing incidence
    F eta;               ///< index of refraction beyond / on the viewer's side; for solids
    MaskOf<F> solid;     ///< what is transmitted is refracted; else the surface is a thin wall
    F transmission;
    F diffuse_transmission;
    Vec3<F> diffuse_transmission_color;
    Vec3<F> sheen_color;
    F sheen_alpha;
    F coat;
    F coat_alpha;
    Vec3<F> coat_normal;  ///< in the shading frame, towards wo
    ThinFilm<F> film;
};

/// What depends on the view direction only: how the layers share the light.
template <typename F>
struct LayeredWeights {
    F below_coat;
    F sheen_scale;
    F below_sheen;
    F diffuse;      ///< what neither reflects at the dielectric boundary nor passes it
    F transmitted;  ///< transmission of the dielectric part
    F p_diffuse, p_facet, p_coat, p_behind;  ///< of sample_layered's lobes, sum 1
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
        const F beyond = refracted_cosine(cosine, p.eta);
        total = select(p.solid & (beyond < F(0.0f)), F(1.0f), F(0.0f));
        const F in_thinner = select(p.eta < F(1.0f), max(beyond, F(0.0f)), cosine);
        inner = select(p.solid, schlick_weight(in_thinner), weight);
    }
    LayeredFresnel<F> r;
    r.dielectric = p.f0 + (splat3(p.f90) - p.f0) * inner;
    r.metal = p.base_color + (splat3(F(1.0f)) - p.base_color) * weight;
    if (any(p.film.strength > F(0.0f))) {
        const Vec3<F> over_dielectric = film_reflectance(cosine, p.film, p.f0);
        const Vec3<F> over_metal = film_reflectance(cosine, p.film, p.base_color);
        r.dielectric = r.dielectric + (over_dielectric - r.dielectric) * p.film.strength;
        r.metal = r.metal + (over_metal - r.metal) * p.film.strength;
    }
    r.dielectric = r.dielectric + (splat3(F(1.0f)) - r.dielectric) * total;
    return r;
}

/// A GGX reflection on a layer of its own normal: its frame's z axis.
template <typename F>
OBSCURA_INLINE BsdfValue<F> coat_lobe(const LayeredParams<F>& p,
                                      const Vec3<F>& wo,
                                      const Vec3<F>& wi) {
    const Frame<F> frame = frame_around(p.coat_normal);
    const Vec3<F> o = to_local(frame, wo);
    const Vec3<F> i = to_local(frame, wi);
    const GgxWidths<F> alpha{p.coat_alpha, p.coat_alpha};
    const Vec3<F> h = normalize(o + i);
    const F reflectance = lerp(F(dielectric_f0), F(1.0f), schlick_weight(dot(o, h)));
    const F over_o = ggx_distribution(h, alpha) / smith_denominator(o, alpha);
    const auto above = (i.z > F(0.0f)) & (wi.z > F(0.0f)) & (o.z > F(0.0f));
    const F value = reflectance * over_o * i.z / smith_denominator(i, alpha);
    return {splat3(select(above, value, F(0.0f))), select(above, over_o * F(0.5f), F(0.0f))};
}

/// Directional albedo of the dielectric boundary as seen from the denser side, where the table for
/// Schlick's curve does not hold: microfacets beyond the critical angle reflect all.
///
/// Errors  none: a mean over fixed microfacets, mostly within 0.01 of the integral, 0.05 at worst
template <typename F>
OBSCURA_INLINE F inner_boundary_albedo(const LayeredParams<F>& p, const Vec3<F>& wo) {
    constexpr int facets = 32;
    constexpr float golden_turn = 0.618034f;  // of the R1 sequence: even around the circle
    F sum(0.0f);
    for (int n = 0; n < facets; ++n) {
        const float number = static_cast<float>(n) + 0.5f;
        const float turns = number * golden_turn;
        const Vec2<F> u{F(turns - static_cast<float>(static_cast<int>(turns))),
                        F(number / static_cast<float>(facets))};
        const Vec3<F> h = sample_visible_normal(wo, p.alpha, u);
        const F cosine = dot(wo, h);
        const Vec3<F> wi = h * (F(2.0f) * cosine) - wo;
        const F masking = F(2.0f) * wi.z / smith_denominator(wi, p.alpha);
        const F reflectance = max_component(layered_fresnel(p, cosine).dielectric);
        sum = sum + select(wi.z > F(0.0f), reflectance * masking, F(0.0f));
    }
    return sum * F(1.0f / facets);
}

/// Shares and probabilities for one view direction, wo.z > 0.
template <typename F>
OBSCURA_INLINE LayeredWeights<F> layered_weights(const LayeredParams<F>& p, const Vec3<F>& wo) {
    const F one(1.0f);
    LayeredWeights<F> w{one, one, one, one, one, one, one, one, one};
    const F zero(0.0f);
    F coat_share = zero;
    if (any(p.coat > zero)) {
        coat_share = p.coat * dielectric_albedo(dot(wo, p.coat_normal), p.coat_alpha);
    }
    w.below_coat = one - coat_share;
    SheenAlbedo<F> sheen{zero, one};
    const F most_sheen = max_component(p.sheen_color);
    if (any(most_sheen > zero)) sheen = sheen_albedo(wo.z, p.sheen_alpha);
    w.sheen_scale = sheen.scale;
    w.below_sheen = one - most_sheen * sheen.albedo;

    const LayeredFresnel<F> fresnel = layered_fresnel(p, wo.z);
    const F roughness = sqrt(sqrt(p.alpha.x * p.alpha.y));
    F boundary = max_component(p.f0) * look_up_albedo(specular_scale_cells, wo.z, roughness) +
                 p.f90 * look_up_albedo(specular_bias_cells, wo.z, roughness);
    boundary = lerp(boundary, max_component(fresnel.dielectric), p.film.strength);
    const F dielectric = one - p.metallic;
    const auto from_within = p.solid & (p.eta < one) & (dielectric * (one - p.transmission) > zero);
    if (any(from_within)) {
        boundary = select(from_within, inner_boundary_albedo(p, wo), boundary);
    }
    w.diffuse = dielectric * (one - p.transmission) * (one - boundary);
    w.transmitted = dielectric * p.transmission;

    const F color = luminance(p.base_color);
    const F reflected = luminance(fresnel.dielectric);
    const F below = w.below_coat * w.below_sheen;
    const F specular =
        below * (dielectric * max(boundary, reflected) + p.metallic * luminance(fresnel.metal));
    const F diffuse = below * w.diffuse * (one - p.diffuse_transmission) * color +
                      w.below_coat * luminance(p.sheen_color) * sheen.albedo;
    const F behind =
        below * w.diffuse * p.diffuse_transmission * luminance(p.diffuse_transmission_color);
    const F transmitted = below * w.transmitted * (one - reflected) * color;
    // What exists at all is tried now and then, for other directions than the mirrored one.
    const F facet = specular + transmitted;
    const F sum = max(facet + diffuse + behind + coat_share, F(1e-6f));
    const auto at_least = [&](const F& share, const MaskOf<F>& exists) {
        return select(exists, max(share / sum, F(0.05f)), F(0.0f));
    };
    w.p_diffuse = at_least(diffuse, diffuse > zero);
    w.p_facet = at_least(facet, (specular > zero) | (w.transmitted * color > zero));
    w.p_coat = at_least(coat_share, p.coat > zero);
    w.p_behind = at_least(behind, behind > zero);
    const F total = w.p_diffuse + w.p_facet + w.p_coat + w.p_behind;
    const F scale = one / max(total, F(1e-6f));
    w.p_diffuse = w.p_diffuse * scale;
    w.p_facet = w.p_facet * scale;
    w.p_coat = w.p_coat * scale;
    w.p_behind = w.p_behind * scale;
    return w;
}

/// What the microfacets leave of the light, dielectric and metal mixed.
template <typename F>
OBSCURA_INLINE Vec3<F> facet_reflectance(const LayeredParams<F>& p,
                                         const LayeredFresnel<F>& fresnel) {
    return fresnel.dielectric * (F(1.0f) - p.metallic) + fresnel.metal * p.metallic;
}

template <typename F>
OBSCURA_INLINE F channel_mean(const Vec3<F>& rgb) {
    return (rgb.x + rgb.y + rgb.z) * F(1.0f / 3);
}

/// Probability that sample_layered reflects at a microfacet rather than going through it: in the
/// proportion of what it leaves of the channels' mean. No channel is more than three times that, so
/// that what microfacets do weighs 3 at most, 1 where it has no colour.
///
/// Source  Walter et al., "Microfacet Models for Refraction", EGSR 2007, sec. 5.3: choosing by the
///         reflectance of the microfacet itself
template <typename F>
OBSCURA_INLINE F facet_reflects(const LayeredParams<F>& p,
                                const LayeredWeights<F>& w,
                                const LayeredFresnel<F>& fresnel) {
    const F passes = F(1.0f) - max_component(fresnel.dielectric);
    const F transmitted = w.transmitted * max(passes, F(0.0f)) * channel_mean(p.base_color);
    const F reflected = channel_mean(facet_reflectance(p, fresnel));
    return select(
        transmitted > F(0.0f), reflected / max(reflected + transmitted, F(1e-20f)), F(1.0f));
}

/// Light that is reflected: wi.z > 0.
template <typename F>
OBSCURA_INLINE BsdfValue<F> layered_reflection(const LayeredParams<F>& p,
                                               const LayeredWeights<F>& w,
                                               const Vec3<F>& wo,
                                               const Vec3<F>& wi) {
    const Vec3<F> h = normalize(wo + wi);
    const LayeredFresnel<F> fresnel = layered_fresnel(p, dot(wo, h));
    const F over_o = ggx_distribution(h, p.alpha) / smith_denominator(wo, p.alpha);
    const F specular = over_o / smith_denominator(wi, p.alpha);  // D * V
    const F one(1.0f);
    Vec3<F> f = p.base_color * (w.diffuse * (one - p.diffuse_transmission) * F(1.0f / pi_f)) +
                facet_reflectance(p, fresnel) * specular;
    f = f * wi.z;
    const F most_sheen = max_component(p.sheen_color);
    if (any(most_sheen > F(0.0f))) {
        const F below_i = one - most_sheen * sheen_albedo(wi.z, p.sheen_alpha).albedo;
        const F sheen = w.sheen_scale * charlie_cos(wo.z, wi.z, h.z, p.sheen_alpha);
        f = f * min(w.below_sheen, below_i) + p.sheen_color * sheen;
    }
    F by_facet = w.p_facet;
    if (any(w.transmitted > F(0.0f))) by_facet = by_facet * facet_reflects(p, w, fresnel);
    F pdf = w.p_diffuse * wi.z * F(1.0f / pi_f) + by_facet * over_o * F(0.5f);
    if (any(p.coat > F(0.0f))) {
        const BsdfValue<F> coat = coat_lobe(p, wo, wi);
        f = f * w.below_coat + coat.value_cos * p.coat;
        pdf = pdf + w.p_coat * coat.pdf;
    }
    return {f, pdf};
}

/// The microfacet that sends wo to wi beyond the surface: half vector and what densities gain.
template <typename F>
struct Crossing {
    Vec3<F> h;
    F cosine;    ///< of wo on the microfacet
    F jacobian;  ///< |dot(wo, h)| * d(h) / d(wi), 1/sr
    MaskOf<F> possible;
};

/// Source  Walter et al., "Microfacet Models for Refraction", EGSR 2007, eq. 16, 17; for thin walls
///         a reflection whose result is mirrored through the surface
template <typename F>
OBSCURA_INLINE Crossing<F> crossing(const LayeredParams<F>& p,
                                    const Vec3<F>& wo,
                                    const Vec3<F>& wi) {
    const Vec3<F> mirrored{wi.x, wi.y, -wi.z};
    const Vec3<F> thin = normalize(wo + mirrored);
    Crossing<F> c{thin, dot(wo, thin), F(0.25f), wi.z < F(0.0f)};
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

/// Light that goes through: wi.z < 0. Radiance is counted per squared index of refraction, which
/// refraction leaves as it is.
template <typename F>
OBSCURA_INLINE BsdfValue<F> layered_transmission(const LayeredParams<F>& p,
                                                 const LayeredWeights<F>& w,
                                                 const Vec3<F>& wo,
                                                 const Vec3<F>& wi) {
    const F zero(0.0f);
    const F one(1.0f);
    const F cosine = -wi.z;
    const F below = w.below_coat * w.below_sheen;
    Vec3<F> value = p.diffuse_transmission_color *
                    (w.diffuse * p.diffuse_transmission * cosine * F(1.0f / pi_f));
    F pdf = w.p_behind * cosine * F(1.0f / pi_f);
    if (any(w.transmitted > zero)) {
        const Crossing<F> c = crossing(p, wo, wi);
        const LayeredFresnel<F> fresnel = layered_fresnel(p, c.cosine);
        const F passes = one - max_component(fresnel.dielectric);
        // D G1(wo) / cos_o, of visible normals
        const F density =
            F(2.0f) * ggx_distribution(c.h, p.alpha) / smith_denominator(wo, p.alpha) * c.jacobian;
        const F masking = F(2.0f) * cosine / smith_denominator(wi, p.alpha);
        const F through = w.transmitted * passes * density * masking;
        value = value + p.base_color * select(c.possible, through, zero);
        const F by_facet = w.p_facet * (one - facet_reflects(p, w, fresnel));
        pdf = pdf + select(c.possible, by_facet * density, zero);
    }
    return {value * below, pdf};
}

/// The material times |cos|, and the density of sample_layered. wo.z > 0; wi on either side.
///
/// Source  KHR_materials_clearcoat, _sheen, _specular, _ior, _transmission, _volume, _iridescence,
///         _anisotropy, _diffuse_transmission; layers lose by directional albedo what the layer
///         above them reflects
template <typename F>
OBSCURA_INLINE BsdfValue<F> evaluate_layered(const LayeredParams<F>& p,
                                             const LayeredWeights<F>& w,
                                             const Vec3<F>& wo,
                                             const Vec3<F>& wi) {
    const auto above = wi.z > F(0.0f);
    const F zero(0.0f);
    BsdfValue<F> at{splat3(zero), zero};
    if (any(above)) {
        const BsdfValue<F> r = layered_reflection(p, w, wo, wi);
        at = {select(above, r.value_cos, at.value_cos), select(above, r.pdf, at.pdf)};
    }
    const auto below = wi.z < zero;
    if (any(below)) {
        const BsdfValue<F> t = layered_transmission(p, w, wo, wi);
        at = {select(below, t.value_cos, at.value_cos), select(below, t.pdf, at.pdf)};
    }
    const auto exists = wo.z > zero;
    return {select(exists, at.value_cos, splat3(zero)), select(exists, at.pdf, zero)};
}

/// Direction through the surface by way of microfacet h; z >= 0 where there is none.
template <typename F>
OBSCURA_INLINE Vec3<F> transmit(const LayeredParams<F>& p, const Vec3<F>& wo, const Vec3<F>& h) {
    const F cosine = dot(wo, h);
    const Vec3<F> mirrored = h * (F(2.0f) * cosine) - wo;
    const Vec3<F> thin{mirrored.x, mirrored.y, -mirrored.z};
    if (none(p.solid)) return thin;
    const F beyond = refracted_cosine(cosine, p.eta);
    const Vec3<F> refracted = h * (cosine / p.eta - beyond) - wo * (F(1.0f) / p.eta);
    const Vec3<F> solid = select(beyond < F(0.0f), Vec3<F>{F(0.0f), F(0.0f), F(1.0f)}, refracted);
    return select(p.solid, solid, thin);
}

/// Chooses wi for a given wo (wo.z > 0), as sample_bsdf does; pdf 0: the path ends.
///
/// In   u: x picks the lobe, then places the direction together with y; z: whether a microfacet,
///      once it is drawn, reflects
template <typename F>
OBSCURA_INLINE BsdfSample<F> sample_layered(const LayeredParams<F>& p,
                                            const LayeredWeights<F>& w,
                                            const Vec3<F>& wo,
                                            const Vec3<F>& u) {
    constexpr int lobes = 4;
    const F shares[lobes] = {w.p_diffuse, w.p_behind, w.p_facet, w.p_coat};
    F begin(0.0f);
    F end(0.0f);
    F from(0.0f);
    F number(0.0f);
    for (int lobe = 0; lobe < lobes; ++lobe) {  // the last one that begins at or below u.x
        end = begin + shares[lobe];
        const auto in = (shares[lobe] > F(0.0f)) & (u.x >= begin);
        from = select(in, begin, from);
        number = select(in, F(static_cast<float>(lobe)), number);
        begin = end;
    }
    F share = shares[0];
    for (int lobe = 1; lobe < lobes; ++lobe)
        share = select(number == F(static_cast<float>(lobe)), shares[lobe], share);
    const F stretched_x = clamp((u.x - from) / max(share, F(1e-6f)), F(0.0f), F(0x1.fffffep-1f));
    const Vec2<F> stretched{stretched_x, u.y};

    const auto behind = number == F(1.0f);
    const auto by_facet = number == F(2.0f);
    const auto coated = number == F(3.0f);
    Vec3<F> wi = cosine_hemisphere(stretched);
    wi.z = select(behind, -wi.z, wi.z);
    auto through = behind;
    if (any(by_facet)) {
        const Vec3<F> h = sample_visible_normal(wo, p.alpha, stretched);
        const F cosine = dot(wo, h);
        wi = select(by_facet, h * (F(2.0f) * cosine) - wo, wi);
        if (any(w.transmitted > F(0.0f))) {
            const F reflects = facet_reflects(p, w, layered_fresnel(p, cosine));
            const auto passes = by_facet & (u.z >= reflects);
            wi = select(passes, transmit(p, wo, h), wi);
            through = through | passes;
        }
    }
    if (any(coated)) {
        const Frame<F> frame = frame_around(p.coat_normal);
        const Vec3<F> o = to_local(frame, wo);
        const Vec3<F> h = sample_visible_normal(o, {p.coat_alpha, p.coat_alpha}, stretched);
        wi = select(coated, to_world(frame, h * (F(2.0f) * dot(o, h)) - o), wi);
    }
    // What a lobe sends to the wrong side ends.
    const auto below = wi.z < F(0.0f);
    const auto fits = (below & through) | ((!below) & (!through));
    BsdfValue<F> at = evaluate_layered(p, w, wo, wi);
    at.pdf = select(fits, at.pdf, F(0.0f));
    const F width = select(coated, p.coat_alpha, sqrt(p.alpha.x * p.alpha.y));
    return {wi, at, select(number < F(2.0f), F(0.4f), F(0.5f) * width)};
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
