// surface/layered_bsdf.h - the glTF material with its extensions: coat over sheen over the base.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/layered_weights.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// A GGX reflection on a layer of its own normal, its frame's z axis; without interreflection.
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
    const F length_o = smith_length(o, alpha);
    const F distribution = ggx_distribution(h, alpha);
    const auto above = (i.z > F(0.0f)) & (wi.z > F(0.0f)) & (o.z > F(0.0f));
    const F visibility = smith_visibility(o.z, length_o, i.z, smith_length(i, alpha));
    const F value = reflectance * distribution * visibility * i.z;
    const F pdf = distribution * F(0.5f) / (o.z + length_o);
    return {splat3(select(above, value, F(0.0f))), select(above, pdf, F(0.0f))};
}

/// Probability that sample_layered reflects at a microfacet rather than going through it: in the
/// proportion of what the facet leaves of the channels' mean. No channel is more than three times
/// that, so that what microfacets do weighs three times their interreflection at most, once where
/// it has no colour. The same for all facets at walls that let light pass less blurred.
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

/// Light that is reflected: wi.z > 0.
template <typename F>
OBSCURA_INLINE BsdfValue<F> layered_reflection(const LayeredParams<F>& p,
                                               const LayeredWeights<F>& w,
                                               const Vec3<F>& wo,
                                               const Vec3<F>& wi) {
    const Vec3<F> h = normalize(wo + wi);
    const LayeredFresnel<F> fresnel = layered_fresnel(p, dot(wo, h));
    const F length_o = smith_length(wo, p.alpha);
    const F distribution = ggx_distribution(h, p.alpha);
    const F specular =
        distribution * smith_visibility(wo.z, length_o, wi.z, smith_length(wi, p.alpha));
    const F one(1.0f);
    Vec3<F> f = p.base_color * (w.diffuse * (one - p.diffuse_transmission) * F(1.0f / pi_f)) +
                facet_reflectance(w, fresnel) * specular;
    f = f * wi.z;
    const F max_sheen = max_component(p.sheen_color);
    if (any(max_sheen > F(0.0f))) {
        const F below_i = one - max_sheen * sheen_albedo(wi.z, p.sheen_alpha).albedo;
        const F sheen = w.sheen_scale * charlie_cos(wo.z, wi.z, h.z, p.sheen_alpha);
        f = f * min(w.below_sheen, below_i) + p.sheen_color * sheen;
    }
    F by_facet = w.p_facet;
    if (any(w.transmitted > F(0.0f))) by_facet = by_facet * facet_reflects(p, w, fresnel);
    F pdf =
        w.p_diffuse * wi.z * F(1.0f / pi_f) + by_facet * distribution * F(0.5f) / (wo.z + length_o);
    if (any(p.coat > F(0.0f))) {
        const BsdfValue<F> coat = coat_lobe(p, wo, wi);
        f = f * w.below_coat + coat.value_cos * (p.coat * w.coat_factor);
        pdf = pdf + w.p_coat * coat.pdf;
    }
    return {f, pdf};
}

/// The microfacet that sends wo to wi on the transmitted side: half vector and what densities gain.
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
    F pdf = w.p_diffuse_transmission * cosine * F(1.0f / pi_f);
    if (any(w.transmitted > zero)) {
        const Crossing<F> c = crossing(p, wo, wi);
        const LayeredFresnel<F> fresnel = layered_fresnel(p, c.cosine);
        const F passes = select(w.facetwise, one - max_component(fresnel.dielectric), one);
        const F length_o = smith_length(wo, w.through_alpha);
        // D G1(wo) / cos_o, of visible normals
        const F density =
            F(2.0f) * ggx_distribution(c.h, w.through_alpha) / (wo.z + length_o) * c.jacobian;
        const F shadowing =
            smith_shadowing(wo.z, length_o, cosine, smith_length(wi, w.through_alpha));
        const F through = w.through_factor * passes * density * shadowing;
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
    const F transmitted_cosine = refracted_cosine(cosine, p.eta);
    const Vec3<F> refracted = h * (cosine / p.eta - transmitted_cosine) - wo * (F(1.0f) / p.eta);
    const Vec3<F> solid =
        select(transmitted_cosine < F(0.0f), Vec3<F>{F(0.0f), F(0.0f), F(1.0f)}, refracted);
    return select(p.solid, solid, thin);
}

/// A lobe of sample_layered, and the number that chose it stretched back over [0, 1).
template <typename F>
struct ChosenLobe {
    F number;  ///< 0 diffuse, 1 diffuse transmission, 2 facets, 3 coat
    F stretched;
};

template <typename F>
OBSCURA_INLINE ChosenLobe<F> choose_lobe(const LayeredWeights<F>& w, const F& u) {
    constexpr int lobes = 4;
    const F probabilities[lobes] = {w.p_diffuse, w.p_diffuse_transmission, w.p_facet, w.p_coat};
    F begin(0.0f);
    F from(0.0f);
    F number(0.0f);
    for (int lobe = 0; lobe < lobes; ++lobe) {  // the last one that begins at or below u
        const auto in = (probabilities[lobe] > F(0.0f)) & (u >= begin);
        from = select(in, begin, from);
        number = select(in, F(static_cast<float>(lobe)), number);
        begin = begin + probabilities[lobe];
    }
    F share = probabilities[0];
    for (int lobe = 1; lobe < lobes; ++lobe)
        share = select(number == F(static_cast<float>(lobe)), probabilities[lobe], share);
    return {number, clamp((u - from) / max(share, F(1e-6f)), F(0.0f), F(0x1.fffffep-1f))};
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
    const ChosenLobe<F> lobe = choose_lobe(w, u.x);
    const Vec2<F> stretched{lobe.stretched, u.y};
    const F number = lobe.number;
    const auto diffuse_transmitted = number == F(1.0f);
    const auto by_facet = number == F(2.0f);
    const auto coated = number == F(3.0f);
    Vec3<F> wi = cosine_hemisphere(stretched);
    wi.z = select(diffuse_transmitted, -wi.z, wi.z);
    auto through = diffuse_transmitted;
    if (any(by_facet)) {
        GgxWidths<F> alpha = p.alpha;
        const auto may_pass = by_facet & (w.transmitted > F(0.0f));
        if (any(may_pass & (!w.facetwise))) {
            const auto passes = may_pass & (!w.facetwise) & (u.z >= w.reflects);
            alpha = {select(passes, w.through_alpha.x, alpha.x),
                     select(passes, w.through_alpha.y, alpha.y)};
        }
        const Vec3<F> h = sample_visible_normal(wo, alpha, stretched);
        const F cosine = dot(wo, h);
        wi = select(by_facet, h * (F(2.0f) * cosine) - wo, wi);
        if (any(may_pass)) {
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
