// surface/fresnel.h - reflectance of boundaries: Schlick, refraction, thin films.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/warp.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Schlick's (1 - cos)^5.
template <typename F>
OBSCURA_INLINE F schlick_weight(const F& cosine) {
    const F m = clamp(F(1.0f) - cosine, F(0.0f), F(1.0f));
    const F m2 = m * m;
    return m2 * m2 * m;
}

/// Transmittance of a clear coat with index 1.5 for light from below; `coat` is its coverage.
/// Source  KHR_materials_clearcoat, Emission
template <typename F>
OBSCURA_INLINE F coat_transmittance(const F& coat, const F& cosine) {
    return F(1.0f) - coat * (F(0.04f) + F(0.96f) * schlick_weight(cosine));
}

/// The mean reflectance of a coat (1 - coat_transmittance at coat = 1) over a Lambertian surface.
inline constexpr float mean_coat_reflectance = 0.04f + 0.96f / 21;

/// Indices of refraction with a smaller relative difference count as equal: the formulas divide by
/// the difference, and refraction would bend light by less than this.
inline constexpr float min_refraction = 1e-3f;

/// Reflectance at normal incidence between media whose indices of refraction have the ratio eta.
template <typename F>
OBSCURA_INLINE F normal_reflectance(const F& eta) {
    return square((eta - F(1.0f)) / (eta + F(1.0f)));
}

/// The f90 of Schlick's formula: 1 from an index of 1.3 on. As the indices become equal, the true
/// reflectance falls to 0 at all angles below 90 degrees, which Schlick's curve to 1 would miss.
///
/// Errors  against Fresnel's equations at 84 degrees: 0.05 at most
template <typename F>
OBSCURA_INLINE F grazing_reflectance(const F& eta) {
    const F difference = max(eta, F(1.0f) / max(eta, F(1e-3f))) - F(1.0f);
    return min(F(1.2f) * difference / (difference + F(0.06f)), F(1.0f));
}

/// Cosine of the refracted ray against the normal; negative under total reflection.
///
/// In      cosine: of the incident ray, >= 0; eta: index of transmitted side / of incident side
template <typename F>
OBSCURA_INLINE F refracted_cosine(const F& cosine, const F& eta) {
    const F sine2 = (F(1.0f) - cosine * cosine) / (eta * eta);
    return select(sine2 < F(1.0f), sqrt(max(F(1.0f) - sine2, F(0.0f))), F(-1.0f));
}

/// Weight of Schlick's rise towards grazing, by the cosine in the thinner of the two media; 1
/// under total reflection.
template <typename F>
OBSCURA_INLINE F boundary_schlick_weight(const F& cosine, const F& eta) {
    const F transmitted_cosine = refracted_cosine(cosine, eta);
    const F weight = schlick_weight(select(eta < F(1.0f), transmitted_cosine, cosine));
    return select(transmitted_cosine < F(0.0f), F(1.0f), weight);
}

/// A thin film on a surface.
template <typename F>
struct ThinFilm {
    F strength;  ///< 0 to 1; see thin_film_presence
    F ior;
    F thickness_nm;
};

/// Strength of a thin film: it fades continuously towards zero thickness, where the formulas below
/// do not.
///
/// Source  KHR_materials_iridescence: no film at a thickness of 0
template <typename F>
OBSCURA_INLINE F thin_film_presence(const F& thickness_nm) {
    const F near_zero = clamp(thickness_nm * F(1.0f / 30), F(0.0f), F(1.0f));
    return near_zero * near_zero * (F(3.0f) - F(2.0f) * near_zero);
}

namespace thin_film {

/// The eye's response to a cosine of the optical path difference, as Rec.709, 1 for a constant.
///
/// In      path_nm: optical path difference; shift: phase, radians
/// Source  Belcour and Barla, "A Practical Extension to Microfacet Theory for the Modeling of
///         Varying Iridescence", TOG 36(4), 2017: Gaussian fits of the CIE curves in frequency
template <typename F>
OBSCURA_INLINE Vec3<F> sensitivity(const F& path_nm, const Vec3<F>& shift) {
    const F phase = path_nm * F(2.0f * pi_f * 1e-9f);
    const F phase2 = phase * phase;
    const auto bell = [&](float value, float position, float variance, const F& offset) {
        return F(value) * sin_cos(F(position) * phase + offset).cos * exp(-(phase2 * F(variance)));
    };
    // value * sqrt(2 pi variance) / 1.0685e-7
    const F x = bell(0.84659f, 1.6810e6f, 4.3278e9f, shift.x) +
                bell(0.15387f, 2.2399e6f, 4.5282e9f, shift.x);
    const F y = bell(1.00024f, 1.7953e6f, 9.3046e9f, shift.y);
    const F z = bell(1.00113f, 2.2084e6f, 6.6121e9f, shift.z);
    return {F(3.2404542f) * x - F(1.5371385f) * y - F(0.4985314f) * z,
            F(-0.9692660f) * x + F(1.8760108f) * y + F(0.0415560f) * z,
            F(0.0556434f) * x - F(0.2040259f) * y + F(1.0572252f) * z};
}

/// Phase shift of a reflection, by the indices on both sides.
template <typename F>
OBSCURA_INLINE F jump(const F& near_ior, const F& far_ior) {
    return select(far_ior < near_ior, F(pi_f), F(0.0f));
}

}  // namespace thin_film

/// Reflectance of a surface under a thin film, seen from air.
///
/// In      cosine: of the incident ray; base: the surface's own reflectance at normal incidence
/// Source  KHR_materials_iridescence, "Theory": Airy sum over the film's inner reflections, two
///         terms after the constant one
template <typename F>
OBSCURA_INLINE Vec3<F> thin_film_reflectance(const F& cosine,
                                             const ThinFilm<F>& thin,
                                             const Vec3<F>& base) {
    const F ior = thin.ior;
    const F inside = refracted_cosine(cosine, ior);
    const F outer_weight = schlick_weight(cosine);
    const F outer = lerp(normal_reflectance(ior), F(1.0f), outer_weight);
    const F through = F(1.0f) - outer;
    const F outer_jump = thin_film::jump(F(1.0f), ior);
    const F path_nm = F(2.0f) * ior * thin.thickness_nm * inside;
    const F inner_weight = schlick_weight(inside);

    Vec3<F> inner, phase;
    const auto channel = [&](const F& reflectance, F& inner_channel, F& phase_channel) {
        const F root = sqrt(clamp(reflectance, F(0.0f), F(0.9999f)));
        const F base_ior = (F(1.0f) + root) / (F(1.0f) - root);
        inner_channel = lerp(normal_reflectance(base_ior / ior), F(1.0f), inner_weight);
        phase_channel = F(pi_f) - outer_jump + thin_film::jump(ior, base_ior);
    };
    channel(base.x, inner.x, phase.x);
    channel(base.y, inner.y, phase.y);
    channel(base.z, inner.z, phase.z);

    const auto each = [](const Vec3<F>& v, const auto& of) {
        return Vec3<F>{of(v.x), of(v.y), of(v.z)};
    };
    const Vec3<F> loop =
        each(inner * outer, [](const F& r) { return clamp(r, F(0.0f), F(0.9999f)); });
    const Vec3<F> inverse = each(loop, [](const F& r) { return F(1.0f) / (F(1.0f) - r); });
    const Vec3<F> series = inner * inverse * (through * through);
    Vec3<F> sum = splat3(outer) + series;
    Vec3<F> term = series - splat3(through);
    const Vec3<F> root = each(loop, [](const F& r) { return sqrt(r); });
    for (int order = 1; order <= 2; ++order) {
        const F n(static_cast<float>(order));
        term = term * root;
        sum = sum + term * thin_film::sensitivity(n * path_nm, phase * n) * F(2.0f);
    }
    const Vec3<F> bounded = each(sum, [](const F& r) { return clamp(r, F(0.0f), F(1.0f)); });
    return select(inside < F(0.0f), splat3(F(1.0f)), bounded);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
