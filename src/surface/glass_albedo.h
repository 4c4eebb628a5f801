// surface/glass_albedo.h - directional albedo of rough glass: reflection plus refraction.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/albedo_table.h"
#include "surface/fresnel.h"

namespace obscura {

/// Steps of the table: seen from the thinner and the denser side; |eta - 1| / (eta + 1), the root
/// of the reflectance at normal incidence, up to glass_last_root; roughness and cosine as in
/// albedo_table.h.
inline constexpr int glass_indices = 25;
inline constexpr int glass_roughnesses = 21;
inline constexpr int glass_cosines = 33;
inline constexpr int glass_nodes = 2 * glass_indices * glass_roughnesses * glass_cosines;
inline constexpr float glass_last_root = 0.6f;  ///< of the index 4

/// Of each node: the albedo with facets that only reflect totally, then with Schlick's reflectance;
/// then both for the next cosine. Written while the project is built, as those of albedo_table.h.
extern const float glass_cells[glass_nodes * 4];

inline namespace OBSCURA_ISA {

/// Directional albedo of a rough boundary, single-scattering reflection plus refraction, for
/// radiance per squared index of refraction.
///
/// In      eta: index of transmitted side / of viewer's side; specular: factor on Schlick's Fresnel
template <typename F>
OBSCURA_INLINE F
glass_albedo(const F& cosine, const F& roughness, const F& eta, const F& specular) {
    using I = IntOf<F>;
    const F zero(0.0f);
    const F one(1.0f);
    const F root = sqrt(abs(eta - one) / (eta + one) * F(1.0f / glass_last_root));
    const F place[3] = {
        clamp(root, zero, one), clamp(roughness, zero, one), sqrt(clamp(cosine, zero, one))};
    const int steps[3] = {glass_indices, glass_roughnesses, glass_cosines};
    I node = select(eta < one, I(1), I(0));
    F fraction[3];
    for (int k = 0; k < 3; ++k) {
        const F x = place[k] * F(static_cast<float>(steps[k] - 1));
        const I step = min(to_int(x), I(steps[k] - 2));
        fraction[k] = x - from_int<F>(step);
        node = node * I(steps[k]) + step;
    }
    const auto along_cosine = [&](int offset) {
        const Four<F> at = gather4<F>(glass_cells, I((node + I(offset)) * I(4)));
        const F total = lerp(at.x, at.z, fraction[2]);
        return total + (lerp(at.y, at.w, fraction[2]) - total) * specular;
    };
    constexpr int next_row = glass_cosines;
    constexpr int next_index = glass_roughnesses * glass_cosines;
    return lerp(lerp(along_cosine(0), along_cosine(next_row), fraction[1]),
                lerp(along_cosine(next_index), along_cosine(next_index + next_row), fraction[1]),
                fraction[0]);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
