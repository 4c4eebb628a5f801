// surface/lobe_shares.h - which part of the scattered light each lobe sends; events by number.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/layered_bsdf.h"

#include <array>

namespace obscura {

/// The scatterings of paths, which light path expressions tell apart, are known by numbers: lobe k
/// of the list is k, and where it is singular k + singular_events; then these two.
inline constexpr size_t singular_events = Lobes::count;
inline constexpr size_t straight_event = 2 * singular_events;  ///< through a smooth thin wall
inline constexpr size_t volume_event = straight_event + 1;     ///< a random walk within a medium
inline constexpr size_t scatter_event_count = volume_event + 1;

template <typename... L>
constexpr std::array<ScatterEvent, scatter_event_count> list_scatter_events(LobeList<L...>) {
    return {L::event...,
            ScatterEvent{L::event.type, 'S', L::event.lobe}...,
            ScatterEvent{'T', 'S', "straight"},
            ScatterEvent{'V', 'D', "volume"}};
}

/// By number.
inline constexpr std::array<ScatterEvent, scatter_event_count> scatter_events =
    list_scatter_events(Lobes{});

inline namespace OBSCURA_ISA {

/// A scattering from one direction into another, in the shading frame.
template <typename F>
struct ScatteredLight {
    Vec3<F> wo, wi;
    Vec3<F> value_cos;  ///< of the whole material, by evaluate_bsdf or evaluate_layered
};

/// What each lobe of the list makes of the light from one direction, and where it is singular.
template <typename F>
struct LobeShares {
    bool is_known[Lobes::count];  ///< false: the lobe sends no light, and the rest is not set
    Vec3<F> share[Lobes::count];  ///< of the sum, in each channel; see share_rounding
    MaskOf<F> singular[Lobes::count];
    MaskOf<F> takes_rest[Lobes::count];  ///< of what the other lobes leave
};

template <typename F>
OBSCURA_INLINE void set_share(
    int lobe, const Vec3<F>& value, MaskOf<F> singular, MaskOf<F> takes_rest, LobeShares<F>& out) {
    out.is_known[lobe] = true;
    out.share[lobe] = value;
    out.singular[lobe] = singular;
    out.takes_rest[lobe] = takes_rest;
}

/// Shares add up to 1 within this: a smaller rest is rounding, and nobody's.
inline constexpr float share_rounding = 1e-6f;

/// Turns the lobes' values into shares of the material's own value. The lobe that takes the rest
/// needs no value.
template <typename F>
OBSCURA_INLINE void normalize_shares(const Vec3<F>& value_cos, LobeShares<F>& out) {
    const F zero(0.0f);
    const F one(1.0f);
    const auto inverse = [&](const F& sum) { return one / max(sum, F(1e-37f)); };
    const Vec3<F> scale{inverse(value_cos.x), inverse(value_cos.y), inverse(value_cos.z)};
    Vec3<F> left = splat3(one);
    for (int k = 0; k < Lobes::count; ++k) {
        if (!out.is_known[k]) continue;
        const Vec3<F> share = out.share[k] * scale;
        const Vec3<F> at_most{min(share.x, left.x), min(share.y, left.y), min(share.z, left.z)};
        out.share[k] = select(out.takes_rest[k], splat3(zero), at_most);
        left = left - out.share[k];
    }
    const auto unless_rounding = [&](const F& x) { return select(x > F(share_rounding), x, zero); };
    left = {unless_rounding(left.x), unless_rounding(left.y), unless_rounding(left.z)};
    for (int k = 0; k < Lobes::count; ++k) {
        if (out.is_known[k]) out.share[k] = select(out.takes_rest[k], left, out.share[k]);
    }
}

/// The shares of evaluate_bsdf's two lobes.
template <typename F>
OBSCURA_INLINE void share_bsdf(const BsdfParams<F>& p,
                               const LobeWeights<F>& lobes,
                               const ScatteredLight<F>& light,
                               LobeShares<F>& out) {
    for (bool& known : out.is_known)
        known = false;
    const Vec3<F> diffuse = p.base_color * (lobes.diffuse * F(1.0f / pi_f) * light.wi.z);
    const MaskOf<F> singular = p.alpha <= F(min_ggx_alpha);
    const MaskOf<F> none(false);
    set_share(Lobes::index<Diffuse>(), diffuse, none, none, out);
    set_share(Lobes::index<FacetReflection>(), splat3(F(0.0f)), singular, MaskOf<F>(true), out);
    normalize_shares(light.value_cos, out);
}

/// The lanes in which a lobe takes what the others leave, which exactly one lobe does: the one that
/// takes longest to evaluate of those on the side that the light goes to.
template <typename L, typename F>
OBSCURA_INLINE MaskOf<F> takes_rest(const Reflection<F>& at) {
    const F zero(0.0f);
    const MaskOf<F> above = at.wi.z > zero;
    const MaskOf<F> has_sheen = max_component(at.p.sheen_color) > zero;
    const MaskOf<F> transmits = at.w.transmitted > zero;
    if constexpr (std::is_same_v<L, Sheen>) {
        return above & has_sheen;
    } else if constexpr (std::is_same_v<L, FacetReflection>) {
        return above & (!has_sheen);
    } else if constexpr (std::is_same_v<L, FacetTransmission>) {
        return (!above) & transmits;
    } else if constexpr (std::is_same_v<L, DiffuseTransmission>) {
        return (!above) & (!transmits);
    } else {
        return MaskOf<F>(false);
    }
}

/// Adds one lobe's value, unless it takes the rest, and dims those before it where it is a layer
/// over them.
template <typename L, typename F>
OBSCURA_INLINE void share_lobe(const Reflection<F>& reflected,
                               const Transmission<F>& transmitted,
                               LobeShares<F>& out) {
    constexpr int k = Lobes::index<L>();
    const F zero(0.0f);
    const Vec3<F> none = splat3(zero);
    const LayeredWeights<F>& w = reflected.w;
    out.is_known[k] = false;
    if constexpr (!L::always_exists) {
        if (!L::exists(reflected.p, w)) return;
    }
    const auto above = reflected.wi.z > zero;
    const MaskOf<F> singular = L::is_singular(reflected.p, w);
    const MaskOf<F> rest = takes_rest<L>(reflected);
    Vec3<F> value = none;
    if constexpr (L::place == LobePlace::layer) {
        const LayerValue<F> layer = L::evaluate(reflected);
        for (int below = 0; below < k; ++below) {
            if (out.is_known[below])
                out.share[below] = out.share[below] * select(above, layer.passes, F(1.0f));
        }
        if constexpr (!std::is_same_v<L, Sheen>)  // which takes the rest in all lanes that have it
            value = select(above, layer.value_cos, none);
    } else if constexpr (L::place == LobePlace::base) {
        if (any(above & (!rest)))
            value = select(above, L::evaluate(reflected).value_cos * reflected.wi.z, none);
    } else if (any((!above) & (!rest))) {
        value = select(above, none, L::evaluate(transmitted).value_cos);
        value = value * (w.below_coat * w.below_sheen);
    }
    set_share(k, value, singular, rest, out);
}

template <typename F, typename... L>
OBSCURA_INLINE void share_lobes(LobeList<L...>,
                                const Reflection<F>& reflected,
                                const Transmission<F>& transmitted,
                                LobeShares<F>& out) {
    (share_lobe<L>(reflected, transmitted, out), ...);
}

/// The shares of evaluate_layered's lobes.
template <typename F>
OBSCURA_INLINE void share_layered(const LayeredParams<F>& p,
                                  const LayeredWeights<F>& w,
                                  const ScatteredLight<F>& light,
                                  LobeShares<F>& out) {
    const auto& [wo, wi, value_cos] = light;
    const Reflection<F> reflected{p, w, wo, wi, normalize(wo + wi)};
    const Transmission<F> transmitted{p, w, wo, wi, abs(wi.z)};
    share_lobes(Lobes{}, reflected, transmitted, out);
    normalize_shares(value_cos, out);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
