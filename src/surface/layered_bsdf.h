// surface/layered_bsdf.h - the glTF material with its extensions: the loops over its lobes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/layered_weights.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// The sum of lobes that always exist. The last of the list is evaluated first: the compiler fuses
/// the first product that it meets with the sum, so that another order would give other last bits.
///
/// In   at: a Reflection or a Transmission
template <typename Pair, typename First, typename... Rest>
OBSCURA_INLINE auto sum_lobes(LobeList<First, Rest...>, const Pair& at) {
    if constexpr (sizeof...(Rest) == 0) {
        return First::evaluate(at);
    } else {
        const auto rest = sum_lobes(LobeList<Rest...>{}, at);
        const auto first = First::evaluate(at);
        return decltype(sum_lobes(LobeList<Rest...>{}, at)){first.value_cos + rest.value_cos,
                                                            first.pdf + rest.pdf};
    }
}

/// Adds a lobe that not all materials have.
template <typename L, typename Pair, typename F>
OBSCURA_INLINE void add_lobe(const Pair& at, BsdfValue<F>& sum) {
    if (!L::exists(at.p, at.w)) return;
    const BsdfValue<F> lobe = L::evaluate(at);
    sum.value_cos = sum.value_cos + lobe.value_cos;
    sum.pdf = sum.pdf + lobe.pdf;
}

template <typename Pair, typename F, typename... L>
OBSCURA_INLINE void add_lobes(LobeList<L...>, const Pair& at, BsdfValue<F>& sum) {
    (add_lobe<L>(at, sum), ...);
}

/// Lays a layer over the sum of what it covers.
template <typename L, typename F>
OBSCURA_INLINE void cover(const Reflection<F>& at, BsdfValue<F>& sum) {
    if (!L::exists(at.p, at.w)) return;
    const LayerValue<F> layer = L::evaluate(at);
    sum.value_cos = sum.value_cos * layer.passes + layer.value_cos;
    if constexpr (L::is_sampled) sum.pdf = sum.pdf + layer.pdf;
}

template <typename F, typename... L>
OBSCURA_INLINE void cover_with_layers(LobeList<L...>, const Reflection<F>& at, BsdfValue<F>& sum) {
    (cover<L>(at, sum), ...);
}

/// Light that is reflected: wi.z > 0.
template <typename F>
OBSCURA_INLINE BsdfValue<F> layered_reflection(const LayeredParams<F>& p,
                                               const LayeredWeights<F>& w,
                                               const Vec3<F>& wo,
                                               const Vec3<F>& wi) {
    const Reflection<F> at{p, w, wo, wi, normalize(wo + wi)};
    BsdfValue<F> sum = sum_lobes(Lobes::At<LobePlace::base, true>{}, at);
    add_lobes(Lobes::At<LobePlace::base, false>{}, at, sum);
    sum.value_cos = sum.value_cos * wi.z;
    cover_with_layers(Lobes::At<LobePlace::layer, false>{}, at, sum);
    return sum;
}

/// Light that goes through: wi.z < 0.
template <typename F>
OBSCURA_INLINE BsdfValue<F> layered_transmission(const LayeredParams<F>& p,
                                                 const LayeredWeights<F>& w,
                                                 const Vec3<F>& wo,
                                                 const Vec3<F>& wi) {
    const Transmission<F> at{p, w, wo, wi, -wi.z};
    BsdfValue<F> sum = sum_lobes(Lobes::At<LobePlace::transmitted, true>{}, at);
    add_lobes(Lobes::At<LobePlace::transmitted, false>{}, at, sum);
    return {sum.value_cos * (w.below_coat * w.below_sheen), sum.pdf};
}

/// The material times |cos|, and the density of sample_layered. wo.z > 0; wi on either side.
///
/// Source  KHR_materials_clearcoat, _sheen, _specular, _ior, _transmission, _volume, _iridescence,
///         _anisotropy, _diffuse_transmission; layers lose by directional albedo what the layer
///         above them reflects
template <typename F>
OBSCURA_INLINE BsdfValue<F> evaluate_layered(const LayeredParams<F>& p,
                                             const LayeredWeights<F>& w,
                                             const Vec3<F>& wo,
                                             const Vec3<F>& wi) {
    const auto above = wi.z > F(0.0f);
    const F zero(0.0f);
    BsdfValue<F> at{splat3(zero), zero};
    if (any(above)) {
        const BsdfValue<F> r = layered_reflection(p, w, wo, wi);
        at = {select(above, r.value_cos, at.value_cos), select(above, r.pdf, at.pdf)};
    }
    const auto below = wi.z < zero;
    if (any(below)) {
        const BsdfValue<F> t = layered_transmission(p, w, wo, wi);
        at = {select(below, t.value_cos, at.value_cos), select(below, t.pdf, at.pdf)};
    }
    const auto exists = wo.z > zero;
    return {select(exists, at.value_cos, splat3(zero)), select(exists, at.pdf, zero)};
}

/// A lobe of sample_layered, and the number that chose it stretched back over [0, 1).
template <typename F>
struct ChosenLobe {
    MaskOf<F> is[SampledLobes::count];  ///< one of them is true
    F stretched;
};

template <typename F, typename... L>
OBSCURA_INLINE ChosenLobe<F> choose_lobe(LobeList<L...>, const LayeredWeights<F>& w, const F& u) {
    constexpr int count = SampledLobes::count;
    const F probabilities[count] = {L::probability(w)...};
    MaskOf<F> begun[count];
    F begin = probabilities[0];
    F from(0.0f);
    F share = probabilities[0];
    for (int n = 1; n < count; ++n) {
        begun[n] = (probabilities[n] > F(0.0f)) & (u >= begin);
        from = select(begun[n], begin, from);
        share = select(begun[n], probabilities[n], share);
        begin = begin + probabilities[n];
    }
    ChosenLobe<F> chosen;
    MaskOf<F> later(false);
    for (int n = count - 1; n > 0; --n) {  // the last one that begins at or below u
        chosen.is[n] = begun[n] & (!later);
        later = later | begun[n];
    }
    chosen.is[0] = !later;
    chosen.stretched = clamp((u - from) / max(share, F(1e-6f)), F(0.0f), F(0x1.fffffep-1f));
    return chosen;
}

/// Lets a lobe draw the directions of the lanes that chose it.
template <typename L, typename F>
OBSCURA_INLINE void draw_lobe(const LobeDraw<F>& draw, LobeSample<F>& sample) {
    if (none(draw.chosen)) return;
    const LobeSample<F> drawn = L::sample(draw);
    sample.direction = select(draw.chosen, drawn.direction, sample.direction);
    sample.transmitted = (draw.chosen & drawn.transmitted) | ((!draw.chosen) & sample.transmitted);
    sample.spread = select(draw.chosen, drawn.spread, sample.spread);
}

template <typename F, typename First, typename... Rest>
OBSCURA_INLINE LobeSample<F> draw_lobes(LobeList<First, Rest...>,
                                        const ChosenLobe<F>& chosen,
                                        LobeDraw<F> draw) {
    draw.chosen = chosen.is[0];
    LobeSample<F> sample = First::sample(draw);
    int n = 0;
    ((draw.chosen = chosen.is[++n], draw_lobe<Rest>(draw, sample)), ...);
    return sample;
}

/// Chooses wi for a given wo (wo.z > 0), as sample_bsdf does; pdf 0: the path ends.
///
/// In   u: x picks the lobe, then places the direction together with y; z: whether a microfacet,
///      once it is drawn, reflects
template <typename F>
OBSCURA_INLINE BsdfSample<F> sample_layered(const LayeredParams<F>& p,
                                            const LayeredWeights<F>& w,
                                            const Vec3<F>& wo,
                                            const Vec3<F>& u) {
    const ChosenLobe<F> chosen = choose_lobe(SampledLobes{}, w, u.x);
    const LobeDraw<F> draw{p, w, wo, MaskOf<F>(true), {chosen.stretched, u.y}, u.z};
    const LobeSample<F> sample = draw_lobes(SampledLobes{}, chosen, draw);
    // What a lobe sends to the wrong side ends.
    const auto below = sample.direction.z < F(0.0f);
    const auto fits = (below & sample.transmitted) | ((!below) & (!sample.transmitted));
    BsdfValue<F> at = evaluate_layered(p, w, wo, sample.direction);
    at.pdf = select(fits, at.pdf, F(0.0f));
    return {sample.direction, at, sample.spread};
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
