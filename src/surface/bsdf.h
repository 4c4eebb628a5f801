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

template <typename F>
struct LobeWeights {
    F diffuse;               ///< scales base_color / pi
    F specular_probability;  ///< that sample_bsdf picks the specular lobe
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

/// cos + sqrt(a^2 + (1 - a^2) cos^2): Smith's G1 is 2 cos divided by this.
template <typename F>
OBSCURA_INLINE F smith_denominator(const F& cosine, const F& alpha) {
    const F a2 = alpha * alpha;
    return cosine + sqrt(a2 + (F(1.0f) - a2) * cosine * cosine);
}

/// How the lobes share the light, for one view direction.
template <typename F>
OBSCURA_INLINE LobeWeights<F> lobe_weights(const BsdfParams<F>& p, const F& cos_o) {
    const F dielectric = dielectric_albedo(cos_o, p.alpha);
    const F diffuse = (F(1.0f) - p.metallic) * (F(1.0f) - dielectric);
    const F base = luminance(p.base_color);
    const F metal = base + (F(1.0f) - base) * schlick_weight(cos_o);
    const F specular_share = lerp(dielectric, metal, p.metallic);
    const F diffuse_share = diffuse * base;
    const F share = specular_share / max(specular_share + diffuse_share, F(1e-6f));
    return {diffuse, select(diffuse_share > F(0.0f), clamp(share, F(0.1f), F(0.9f)), F(1.0f))};
}

/// The BRDF times cosine, and the density of sample_bsdf; both zero below either horizon.
///
/// The dielectric's diffuse part is what its specular lobe leaves over, by directional albedo: the
/// two together never reflect more light than arrives, and all of it when the base is white.
///
/// Source  glTF 2.0, Appendix B: mix(dielectric, metal, metallic) with Schlick's Fresnel on the
///         half vector, Lambert under the dielectric's specular lobe, GGX with separable Smith
///         shadowing; Kulla and Conty, "Revisiting Physically Based Shading at Imageworks", 2017
///         (albedo scaling)
template <typename F>
OBSCURA_INLINE BsdfValue<F> evaluate_bsdf(const BsdfParams<F>& p,
                                          const LobeWeights<F>& lobes,
                                          const Vec3<F>& wo,
                                          const Vec3<F>& wi) {
    const auto above = (wo.z > F(0.0f)) & (wi.z > F(0.0f));
    const Vec3<F> h = normalize(wo + wi);
    const F weight = schlick_weight(dot(wo, h));
    const F fd = F(dielectric_f0) + F(1.0f - dielectric_f0) * weight;
    const F distribution = ggx_distribution(h, p.alpha);
    const F denominator_o = smith_denominator(wo.z, p.alpha);
    const F denominator_i = smith_denominator(wi.z, p.alpha);
    const F specular = distribution / (denominator_o * denominator_i);  // D * V
    const F dielectric = (F(1.0f) - p.metallic) * fd;
    const Vec3<F> metal = (p.base_color + (splat3(F(1.0f)) - p.base_color) * weight) * p.metallic;
    const Vec3<F> f =
        p.base_color * (lobes.diffuse * F(1.0f / pi_f)) + (splat3(dielectric) + metal) * specular;
    const F pdf = lobes.specular_probability * distribution / (F(2.0f) * denominator_o) +
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
