// surface/stretched_albedo.h - directional albedo of anisotropic microfacets.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/albedo_table.h"
#include "surface/ggx.h"

namespace obscura {

/// Dimensions of the table, outermost first: ratio of the two widths, the narrower one as
/// perceptual roughness, the width along the view direction between both, the cosine as in
/// albedo_table.h.
inline constexpr int stretched_ratios = 9;
inline constexpr int stretched_roughnesses = 13;
inline constexpr int stretched_turns = 7;
inline constexpr int stretched_cosines = 17;
inline constexpr int stretched_nodes =
    stretched_ratios * stretched_roughnesses * stretched_turns * stretched_cosines;

/// mirror and grazing (SpecularAlbedo) of each node, then those of the next cosine. Written while
/// the project is built, as those of albedo_table.h.
extern const float stretched_cells[stretched_nodes * 4];

inline namespace OBSCURA_ISA {

/// SpecularAlbedo of a surface whose two widths differ.
///
/// In   wo: in the shading frame, wo.z >= 0
template <typename F>
OBSCURA_INLINE SpecularAlbedo<F> stretched_albedo(const Vec3<F>& wo, const GgxWidths<F>& alpha) {
    using I = IntOf<F>;
    const F one(1.0f);
    const F wide = max(alpha.x, alpha.y);
    const F narrow = min(alpha.x, alpha.y);
    const F difference = max(wide - narrow, F(1e-6f));
    const F along2 = square(wo.x * alpha.x) + square(wo.y * alpha.y);
    const F along = sqrt(along2 / max(wo.x * wo.x + wo.y * wo.y, F(1e-12f)));

    I node(0);
    F fraction[4];
    const int steps[4] = {
        stretched_ratios, stretched_roughnesses, stretched_turns, stretched_cosines};
    const F place[4] = {sqrt(difference / max(one - narrow, F(1e-6f))),
                        sqrt(narrow),
                        (along - narrow) / difference,
                        sqrt(clamp(wo.z, F(0.0f), one))};
    for (int k = 0; k < 4; ++k) {
        const F x = clamp(place[k], F(0.0f), one) * F(static_cast<float>(steps[k] - 1));
        const I step = min(to_int(x), I(steps[k] - 2));
        fraction[k] = x - from_int<F>(step);
        node = node * I(steps[k]) + step;
    }
    SpecularAlbedo<F> sum{F(0.0f), F(0.0f)};
    for (int corner = 0; corner < 8; ++corner) {
        const int up[3] = {corner >> 2 & 1, corner >> 1 & 1, corner & 1};
        F weight = one;
        int offset = 0;
        for (int k = 0; k < 3; ++k) {
            weight = weight * (up[k] == 1 ? fraction[k] : one - fraction[k]);
            offset = offset * steps[k] + up[k];
        }
        const I cell = (node + I(offset * stretched_cosines)) * I(4);
        const Four<F> at = gather4<F>(stretched_cells, cell);
        sum.mirror = sum.mirror + weight * lerp(at.x, at.z, fraction[3]);
        sum.grazing = sum.grazing + weight * lerp(at.y, at.w, fraction[3]);
    }
    return sum;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
