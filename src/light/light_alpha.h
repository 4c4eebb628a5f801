// light/light_alpha.h - what emitters with alpha MASK and BLEND let out, at any of their points.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/table_record.h"
#include "surface/texture.h"

#include <cstdint>

namespace obscura {

/// The alpha of one emissive triangle or shape, 32-bit words only. A shape has the corners u, v =
/// (0, 0), (1, 0) and (0, 1) of its texture coordinates.
struct LightAlpha {
    float factor[3] = {1, 1, 1};  ///< at the corners: the material's alpha times the vertex's
    float uv0[2] = {0, 0};        ///< in the texture, at the corners
    float uv1[2] = {0, 0};
    float uv2[2] = {0, 0};
    int32_t texture = -1;  ///< base colour, whose alpha multiplies the factor; -1: none
    int32_t is_mask = 0;   ///< 1: MASK, all or nothing; 0: BLEND
    float cutoff = 0;      ///< of MASK: the least alpha that is not passed
    float mean = 1;        ///< of what it lets out, over its area
};

static_assert(sizeof(LightAlpha) == 13 * 4, "read as 32-bit words: no padding");

inline namespace OBSCURA_ISA {

/// An alpha in registers.
template <typename F>
struct LightAlphaValues {
    F factor[3];
    Vec2<F> uv[3];
    IntOf<F> texture;
    MaskOf<F> is_mask;
    F cutoff;
};

/// One for all lanes.
template <typename F>
OBSCURA_INLINE LightAlphaValues<F> spread(const LightAlpha& a) {
    return {{F(a.factor[0]), F(a.factor[1]), F(a.factor[2])},
            {{F(a.uv0[0]), F(a.uv0[1])}, {F(a.uv1[0]), F(a.uv1[1])}, {F(a.uv2[0]), F(a.uv2[1])}},
            IntOf<F>(a.texture),
            MaskOf<F>(a.is_mask != 0),
            F(a.cutoff)};
}

template <typename F>
OBSCURA_INLINE LightAlphaValues<F> read_light_alpha(const TableRecord<F, LightAlpha>& record) {
    using A = LightAlpha;
    const auto factor = [&](int k) { return record.template number<&A::factor>(k); };
    return {{factor(0), factor(1), factor(2)},
            {{record.template number<&A::uv0>(0), record.template number<&A::uv0>(1)},
             {record.template number<&A::uv1>(0), record.template number<&A::uv1>(1)},
             {record.template number<&A::uv2>(0), record.template number<&A::uv2>(1)}},
            record.template integer<&A::texture>(),
            record.template integer<&A::is_mask>() != IntOf<F>(0),
            record.template number<&A::cutoff>()};
}

/// The fraction of its light that an emitter lets out at a point: the probability that a ray which
/// meets the point hits it. The texture is read as accel/alpha_filter.cpp reads it for rays.
///
/// In      weight: of the second and the third corner
/// Out     in [0, 1]
template <typename F>
OBSCURA_INLINE F light_alpha(const TextureView& textures,
                             const LightAlphaValues<F>& light,
                             const Vec2<F>& weight) {
    const F first = F(1.0f) - weight.x - weight.y;
    F alpha = first * light.factor[0] + weight.x * light.factor[1] + weight.y * light.factor[2];
    const auto textured = light.texture >= IntOf<F>(0);
    if (any(textured)) {
        const Vec2<F>(&uv)[3] = light.uv;
        const Vec2<F> at{first * uv[0].x + weight.x * uv[1].x + weight.y * uv[2].x,
                         first * uv[0].y + weight.x * uv[1].y + weight.y * uv[2].y};
        const Rgba<F> texel = sample_texture_bilinear<F>(
            textures, select(textured, light.texture, IntOf<F>(0)), at, F(0.0f));
        alpha = select(textured, alpha * texel.alpha, alpha);
    }
    const F kept = select(alpha >= light.cutoff, F(1.0f), F(0.0f));
    return select(light.is_mask, kept, clamp(alpha, F(0.0f), F(1.0f)));
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
