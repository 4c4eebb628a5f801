// surface/sheen.h - the Charlie lobe of KHR_materials_sheen, for cloth.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/albedo_table.h"

namespace obscura {

/// Minimum width of sheen, for numerical stability.
inline constexpr float min_sheen_alpha = 0.005f;

inline namespace OBSCURA_ISA {

/// x to the power y, for x > 0.
template <typename F>
OBSCURA_INLINE F power(const F& x, const F& y) {
    return exp(log2(x) * y * F(0.693147181f));
}

/// Distribution of fibres' normals.
/// Source  Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF", SIGGRAPH 2017 course
template <typename F>
OBSCURA_INLINE F charlie_distribution(const F& cosine, const F& alpha) {
    const F sine2 = max(F(1.0f) - cosine * cosine, F(1e-12f));
    const F inverse = F(1.0f) / alpha;
    return (F(2.0f) + inverse) * power(sine2, inverse * F(0.5f)) * F(0.5f / pi_f);
}

/// Masking function, fitted.
/// Source  as charlie_distribution, table 1
template <typename F>
OBSCURA_INLINE F charlie_lambda(const F& cosine, const F& alpha) {
    const F t = square(F(1.0f) - alpha);
    const F a = lerp(F(21.5473f), F(25.3245f), t);
    const F b = lerp(F(3.82987f), F(3.32435f), t);
    const F c = lerp(F(0.19823f), F(0.16801f), t);
    const F d = lerp(F(-1.97760f), F(-1.27393f), t);
    const F e = lerp(F(-4.32054f), F(-4.85967f), t);
    const auto fit = [&](const F& x) {
        return a / (F(1.0f) + b * power(max(x, F(1e-6f)), c)) + d * x + e;
    };
    const auto steep = cosine < F(0.5f);
    const F folded = fit(select(steep, cosine, F(1.0f) - cosine));
    return exp(select(steep, folded, F(2.0f) * fit(F(0.5f)) - folded));
}

/// The lobe for a white sheen colour, times cos_i. Cosines are of wo, wi and the half vector, > 0.
template <typename F>
OBSCURA_INLINE F charlie_cos(const F& cos_o, const F& cos_i, const F& cos_h, const F& alpha) {
    const F visibility = F(1.0f) + charlie_lambda(cos_o, alpha) + charlie_lambda(cos_i, alpha);
    return charlie_distribution(cos_h, alpha) / (F(4.0f) * max(cos_o, F(1e-6f)) * visibility);
}

/// Directional albedo of the lobe. At grazing angles narrow lobes would exceed 1; `scale` limits
/// them to 1.
template <typename F>
struct SheenAlbedo {
    F albedo;  ///< after scaling, at most 1
    F scale;
};

/// The albedo before scaling: of narrow fibres above 1.
template <typename F>
OBSCURA_INLINE F unscaled_sheen_albedo(const F& cosine, const F& alpha) {
    const AlbedoCell<F> cell = albedo_cell(cosine, sqrt(alpha));
    const Four<F> corners = gather4<F>(sheen_cells, IntOf<F>(cell.index * IntOf<F>(4)));
    return bilinear(corners, cell.x, cell.y);
}

template <typename F>
OBSCURA_INLINE SheenAlbedo<F> scaled_sheen_albedo(const F& unscaled) {
    return {min(unscaled, F(1.0f)), F(1.0f) / max(unscaled, F(1.0f))};
}

template <typename F>
OBSCURA_INLINE SheenAlbedo<F> sheen_albedo(const F& cosine, const F& alpha) {
    return scaled_sheen_albedo(unscaled_sheen_albedo(cosine, alpha));
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
