// surface/albedo_table.h - how much of a white sky a lobe reflects, by angle and roughness.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/gather4.h"

namespace obscura {

inline constexpr int albedo_cosines = 32;
inline constexpr int albedo_roughnesses = 32;

/// Normal-incidence reflectance of a dielectric with index of refraction 1.5.
inline constexpr float dielectric_f0 = 0.04f;

/// At cosine (c / (albedo_cosines - 1))^2, dense where the lobe changes fastest, and perceptual
/// roughness r / (albedo_roughnesses - 1): entry r * albedo_cosines + c. The albedo for reflectance
/// f0 at normal incidence is f0 * scale + bias.
extern const float specular_albedo_scale[albedo_cosines * albedo_roughnesses];
extern const float specular_albedo_bias[albedo_cosines * albedo_roughnesses];
/// Of the Charlie lobe (surface/sheen.h) with a white colour.
extern const float sheen_albedo_table[albedo_cosines * albedo_roughnesses];

/// A table whose cells have their four corners beside each other, so that a look-up reads once:
/// entries (r, c), (r, c + 1), (r + 1, c), (r + 1, c + 1).
struct AlbedoCells {
    float corners[albedo_cosines * albedo_roughnesses * 4];
};

extern const AlbedoCells specular_scale_cells;
extern const AlbedoCells specular_bias_cells;
extern const AlbedoCells dielectric_cells;  ///< of dielectric_f0
extern const AlbedoCells sheen_cells;

inline namespace OBSCURA_ISA {

/// Bilinear look-up.
template <typename F>
OBSCURA_INLINE F look_up_albedo(const AlbedoCells& cells, const F& cosine, const F& roughness) {
    using I = IntOf<F>;
    const F x = sqrt(clamp(cosine, F(0.0f), F(1.0f))) * F(static_cast<float>(albedo_cosines - 1));
    const F y = clamp(roughness, F(0.0f), F(1.0f)) * F(static_cast<float>(albedo_roughnesses - 1));
    const I column = min(to_int(x), I(albedo_cosines - 2));
    const I row = min(to_int(y), I(albedo_roughnesses - 2));
    const F fx = x - from_int<F>(column);
    const F fy = y - from_int<F>(row);
    const I cell = row * I(albedo_cosines) + column;
    const Four<F> corner = gather4<F>(cells.corners, I(cell * I(4)));
    return lerp(lerp(corner.x, corner.y, fx), lerp(corner.z, corner.w, fx), fy);
}

/// Share of a white sky that a specular lobe with reflectance f0 reflects towards `cosine`.
///
/// Errors  interpolation: below 0.003 for f0 = 0.04 and cosine > 0.05
/// Source  Karis, "Real Shading in Unreal Engine 4", SIGGRAPH 2013 course (split into scale, bias)
template <typename F>
OBSCURA_INLINE F specular_albedo(const F& f0, const F& cosine, const F& alpha) {
    const F roughness = sqrt(alpha);
    return f0 * look_up_albedo(specular_scale_cells, cosine, roughness) +
           look_up_albedo(specular_bias_cells, cosine, roughness);
}

/// The same for dielectric_f0.
template <typename F>
OBSCURA_INLINE F dielectric_albedo(const F& cosine, const F& alpha) {
    return look_up_albedo(dielectric_cells, cosine, sqrt(alpha));
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
