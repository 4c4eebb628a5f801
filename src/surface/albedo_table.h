// surface/albedo_table.h - how much of a white sky a lobe reflects, by angle and roughness.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/lanes.h"

namespace obscura {

inline constexpr int albedo_cosines = 32;
inline constexpr int albedo_roughnesses = 32;

/// At cosine (c / (albedo_cosines - 1))^2, dense where the lobe changes fastest, and perceptual
/// roughness r / (albedo_roughnesses - 1): entry r * albedo_cosines + c. The albedo for reflectance
/// f0 at normal incidence is f0 * scale + bias.
extern const float specular_albedo_scale[albedo_cosines * albedo_roughnesses];
extern const float specular_albedo_bias[albedo_cosines * albedo_roughnesses];
/// Of the Charlie lobe (surface/sheen.h) with a white colour.
extern const float sheen_albedo_table[albedo_cosines * albedo_roughnesses];

inline namespace OBSCURA_ISA {

/// Bilinear look-up in one of the tables.
template <typename F>
OBSCURA_INLINE F look_up_albedo(const float* table, const F& cosine, const F& roughness) {
    using I = IntOf<F>;
    const F x = sqrt(clamp(cosine, F(0.0f), F(1.0f))) * F(static_cast<float>(albedo_cosines - 1));
    const F y = clamp(roughness, F(0.0f), F(1.0f)) * F(static_cast<float>(albedo_roughnesses - 1));
    const I column = min(to_int(x), I(albedo_cosines - 2));
    const I row = min(to_int(y), I(albedo_roughnesses - 2));
    const F fx = x - from_int<F>(column);
    const F fy = y - from_int<F>(row);
    const I at = row * I(albedo_cosines) + column;
    const F low = lerp(gather<F>(table, at), gather<F>(table + 1, at), fx);
    const F high =
        lerp(gather<F>(table + albedo_cosines, at), gather<F>(table + albedo_cosines + 1, at), fx);
    return lerp(low, high, fy);
}

/// Share of a white sky that a specular lobe with reflectance f0 reflects towards `cosine`.
///
/// Errors  interpolation: below 0.003 for f0 = 0.04 and cosine > 0.05
/// Source  Karis, "Real Shading in Unreal Engine 4", SIGGRAPH 2013 course (split into scale, bias)
template <typename F>
OBSCURA_INLINE F specular_albedo(const F& f0, const F& cosine, const F& alpha) {
    const F roughness = sqrt(alpha);
    return f0 * look_up_albedo(specular_albedo_scale, cosine, roughness) +
           look_up_albedo(specular_albedo_bias, cosine, roughness);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
