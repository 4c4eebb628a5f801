// surface/lobes/coat.h - the clear coat: a glossy dielectric layer over all others.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/lobes/lobe.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// A GGX reflection on a layer of its own normal, its frame's z axis.
/// Source  KHR_materials_clearcoat
struct Coat : Lobe {
    static constexpr LobePlace place = LobePlace::layer;
    static constexpr ScatterEvent event{'R', 'G', "coat"};
    static constexpr bool always_exists = false;

    template <typename F>
    struct Params {
        F coat;
        F coat_alpha;
        Vec3<F> coat_normal;  ///< in the shading frame, towards wo
    };

    template <typename F>
    struct Weights {
        F below_coat;
        F coat_factor;  ///< interreflection of its facets
        F p_coat;
    };

    template <typename F>
    OBSCURA_INLINE static void weigh(const LayeredParams<F>& p,
                                     const Vec3<F>& wo,
                                     LayeredWeights<F>& w) {
        const F one(1.0f);
        w.below_coat = one;
        w.coat_factor = one;
        if (none(p.coat > F(0.0f))) return;
        const F cosine = dot(wo, p.coat_normal);
        const DielectricLobe<F> coat = dielectric_lobe(specular_albedo(cosine, p.coat_alpha));
        w.below_coat = one - p.coat * coat.albedo;
        w.coat_factor = coat.factor;
    }

    template <typename F>
    OBSCURA_INLINE static bool exists(const LayeredParams<F>& p, const LayeredWeights<F>&) {
        return any(p.coat > F(0.0f));
    }

    template <typename F>
    OBSCURA_INLINE static MaskOf<F> is_singular(const LayeredParams<F>& p,
                                                const LayeredWeights<F>&) {
        return p.coat_alpha <= F(min_ggx_alpha);
    }

    template <typename F>
    OBSCURA_INLINE static LayerValue<F> evaluate(const Reflection<F>& at) {
        const LayeredParams<F>& p = at.p;
        const Frame<F> frame = frame_around(p.coat_normal);
        const Vec3<F> o = to_local(frame, at.wo);
        const Vec3<F> i = to_local(frame, at.wi);
        const GgxWidths<F> alpha{p.coat_alpha, p.coat_alpha};
        const Vec3<F> h = normalize(o + i);
        const F reflectance = lerp(F(dielectric_f0), F(1.0f), schlick_weight(dot(o, h)));
        const F length_o = smith_length(o, alpha);
        const F distribution = ggx_distribution(h, alpha);
        const auto above = (i.z > F(0.0f)) & (at.wi.z > F(0.0f)) & (o.z > F(0.0f));
        const F visibility = smith_visibility(o.z, length_o, i.z, smith_length(i, alpha));
        const F value = reflectance * distribution * visibility * i.z;
        const F pdf = distribution * F(0.5f) / (o.z + length_o);
        return {splat3(select(above, value, F(0.0f))) * (p.coat * at.w.coat_factor),
                at.w.p_coat * select(above, pdf, F(0.0f)),
                at.w.below_coat};
    }

    template <typename F>
    OBSCURA_INLINE static LobeShare<F> share(const LobeView<F>& view, const LayeredWeights<F>& w) {
        return {F(1.0f) - w.below_coat, view.p.coat > F(0.0f)};
    }

    template <typename Weights>
    OBSCURA_INLINE static auto& probability(Weights& w) {
        return w.p_coat;
    }

    template <typename F>
    OBSCURA_INLINE static LobeSample<F> sample(const LobeDraw<F>& draw) {
        const LayeredParams<F>& p = draw.p;
        const Frame<F> frame = frame_around(p.coat_normal);
        const Vec3<F> o = to_local(frame, draw.wo);
        const Vec3<F> h = sample_visible_normal(o, {p.coat_alpha, p.coat_alpha}, draw.u);
        return {to_world(frame, h * (F(2.0f) * dot(o, h)) - o),
                MaskOf<F>(false),
                F(0.5f) * p.coat_alpha};
    }
};

}  // namespace OBSCURA_ISA
}  // namespace obscura
