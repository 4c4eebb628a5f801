// surface/bsdf.h - the glTF metallic-roughness BRDF: value, density and sampling.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/albedo_table.h"
#include "surface/fresnel.h"
#include "surface/ggx.h"

namespace obscura {

/// Roughness below this is rendered as this: narrower lobes leave float's range.
inline constexpr float min_ggx_alpha = 1e-3f;

/// A surface point's material, all textures applied.
template <typename F>
struct BsdfParams {
    Vec3<F> base_color;
    F metallic;
    F alpha;  ///< GGX width, square of the perceptual roughness, >= min_ggx_alpha
};

/// What depends on the view direction only: how the lobes share the light.
template <typename F>
struct LobeWeights {
    F diffuse;               ///< scales base_color / pi
    F specular_probability;  ///< that sample_bsdf picks the specular lobe
    Vec3<F> specular_f0;     ///< of all facets at normal incidence, with interreflection
    Vec3<F> specular_rise;   ///< from there to grazing incidence
};

/// Directions are in the shading frame (z is the normal) and point away from the surface.
template <typename F>
struct BsdfValue {
    Vec3<F> value_cos;  ///< f(wo, wi) * cos(theta_i), 1/sr
    F pdf;              ///< of sample_bsdf choosing wi, 1/sr
};

template <typename F>
struct BsdfSample {
    Vec3<F> direction;
    BsdfValue<F> at;
    F spread;  ///< how much the footprint widens: metres per metre
};

inline namespace OBSCURA_ISA {

/// GGX distribution from the half vector's components: stable for narrow lobes, where the usual
/// (n.h)^2 (a^2 - 1) + 1 cancels.
/// Source  Walter et al., "Microfacet Models for Refraction", EGSR 2007, eq. 33
template <typename F>
OBSCURA_INLINE F ggx_distribution(const Vec3<F>& h, const F& alpha) {
    const F a2 = alpha * alpha;
    const F t = (h.x * h.x + h.y * h.y) / a2 + h.z * h.z;
    return F(1.0f) / (F(pi_f) * a2 * t * t);
}

/// smith_length of a direction with this cosine, for one width.
template <typename F>
OBSCURA_INLINE F smith_length(const F& cosine, const F& alpha) {
    const F a2 = alpha * alpha;
    return sqrt(a2 + (F(1.0f) - a2) * cosine * cosine);
}

/// How the lobes share the light, for one view direction.
template <typename F>
OBSCURA_INLINE LobeWeights<F> lobe_weights(const BsdfParams<F>& p, const F& cos_o) {
    const F one(1.0f);
    const SpecularAlbedo<F> once = specular_albedo(cos_o, p.alpha);
    const DielectricLobe<F> dielectric = dielectric_lobe(once);
    const F plastic = (one - p.metallic) * dielectric.factor;
    const Vec3<F> metal = interreflection(once.mirror, mean_schlick(p.base_color)) * p.metallic;
    LobeWeights<F> w;
    w.diffuse = (one - p.metallic) * (one - dielectric.albedo);
    w.specular_f0 = p.base_color * metal + splat3(plastic * F(dielectric_f0));
    w.specular_rise = metal + splat3(plastic) - w.specular_f0;
    const F specular_weight =
        luminance(w.specular_f0) * once.mirror + luminance(w.specular_rise) * once.grazing;
    const F diffuse_weight = w.diffuse * luminance(p.base_color);
    const F share = specular_weight / max(specular_weight + diffuse_weight, F(1e-6f));
    w.specular_probability = select(diffuse_weight > F(0.0f), clamp(share, F(0.1f), F(0.9f)), one);
    return w;
}

/// The BRDF times cosine, and the density of sample_bsdf; both zero below either horizon.
///
/// The dielectric's diffuse part is what its specular lobe leaves over, by directional albedo: the
/// two together never reflect more light than arrives, and all of it when the base is white.
///
/// Source  glTF 2.0, Appendix B: mix(dielectric, metal, metallic) with Schlick's Fresnel on the
///         half vector, Lambert under the dielectric's specular lobe, GGX with height-correlated
///         Smith masking and multiple scattering (see interreflection); Kulla and Conty,
///         "Revisiting Physically Based Shading at Imageworks", 2017 (albedo scaling)
template <typename F>
OBSCURA_INLINE BsdfValue<F> evaluate_bsdf(const BsdfParams<F>& p,
                                          const LobeWeights<F>& lobes,
                                          const Vec3<F>& wo,
                                          const Vec3<F>& wi) {
    const auto above = (wo.z > F(0.0f)) & (wi.z > F(0.0f));
    const Vec3<F> h = normalize(wo + wi);
    const Vec3<F> fresnel = lobes.specular_f0 + lobes.specular_rise * schlick_weight(dot(wo, h));
    const F distribution = ggx_distribution(h, p.alpha);
    const F length_o = smith_length(wo.z, p.alpha);
    const F length_i = smith_length(wi.z, p.alpha);
    const F specular = distribution * smith_visibility(wo.z, length_o, wi.z, length_i);
    const Vec3<F> f = p.base_color * (lobes.diffuse * F(1.0f / pi_f)) + fresnel * specular;
    const F pdf = lobes.specular_probability * distribution / (F(2.0f) * (wo.z + length_o)) +
                  (F(1.0f) - lobes.specular_probability) * wi.z * F(1.0f / pi_f);
    const F zero = F(0.0f);
    return {select(above, f * wi.z, splat3(zero)), select(above, pdf, zero)};
}

template <typename F>
OBSCURA_INLINE BsdfValue<F> evaluate_bsdf(const BsdfParams<F>& p,
                                          const Vec3<F>& wo,
                                          const Vec3<F>& wi) {
    return evaluate_bsdf(p, lobe_weights(p, wo.z), wo, wi);
}

/// Chooses wi for a given wo (wo.z > 0). pdf 0 means that the path ends: below the horizon.
///
/// u.x first picks the lobe and is then stretched back over [0, 1): points that are spread evenly
/// over all samples stay so within each lobe.
template <typename F>
OBSCURA_INLINE BsdfSample<F> sample_bsdf(const BsdfParams<F>& p,
                                         const LobeWeights<F>& lobes,
                                         const Vec3<F>& wo,
                                         const Vec2<F>& u) {
    const F one_below = F(0x1.fffffep-1f);
    const auto specular = u.x < lobes.specular_probability;
    const F begin = select(specular, F(0.0f), lobes.specular_probability);
    const F end = select(specular, lobes.specular_probability, F(1.0f));
    const Vec2<F> stretched{clamp((u.x - begin) / (end - begin), F(0.0f), one_below), u.y};
    const Vec3<F> h = sample_visible_normal(wo, {p.alpha, p.alpha}, stretched);
    const Vec3<F> mirrored = h * (F(2.0f) * dot(wo, h)) - wo;
    const Vec3<F> wi = select(specular, mirrored, cosine_hemisphere(stretched));
    return {wi, evaluate_bsdf(p, lobes, wo, wi), select(specular, F(0.5f) * p.alpha, F(0.4f))};
}

template <typename F>
OBSCURA_INLINE BsdfSample<F> sample_bsdf(const BsdfParams<F>& p,
                                         const Vec3<F>& wo,
                                         const Vec2<F>& u) {
    return sample_bsdf(p, lobe_weights(p, wo.z), wo, u);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
