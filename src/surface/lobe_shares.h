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

/// What each lobe of the list makes of the light from one direction, and where it is singular.
template <typename F>
struct LobeShares {
    bool is_known[Lobes::count];  ///< false: the lobe sends no light, and the rest is not set
    Vec3<F> share[Lobes::count];  ///< of the sum: they add up to 1 in each channel
    MaskOf<F> singular[Lobes::count];
};

template <typename F>
OBSCURA_INLINE void set_share(int lobe,
                              const Vec3<F>& value,
                              MaskOf<F> singular,
                              LobeShares<F>& out) {
    out.is_known[lobe] = true;
    out.share[lobe] = value;
    out.singular[lobe] = singular;
}

/// Turns the lobes' values into shares. Where no lobe sends light, the first one takes all.
///
/// In   the first lobe is known
template <typename F>
OBSCURA_INLINE void normalize_shares(LobeShares<F>& out) {
    const F zero(0.0f);
    const F one(1.0f);
    Vec3<F> sum = splat3(zero);
    for (int k = 0; k < Lobes::count; ++k) {
        if (out.is_known[k]) sum = sum + out.share[k];
    }
    const auto scale = [&](const F& total) {
        return select(total > zero, one / max(total, F(1e-37f)), zero);
    };
    const Vec3<F> scales{scale(sum.x), scale(sum.y), scale(sum.z)};
    for (int k = 0; k < Lobes::count; ++k) {
        if (out.is_known[k]) out.share[k] = out.share[k] * scales;
    }
    const auto dark = [&](const F& total, const F& share) {
        return select(total > zero, share, one);
    };
    Vec3<F>& first = out.share[0];
    first = {dark(sum.x, first.x), dark(sum.y, first.y), dark(sum.z, first.z)};
}

/// The shares of evaluate_bsdf's two lobes.
template <typename F>
OBSCURA_INLINE void share_bsdf(const BsdfParams<F>& p,
                               const LobeWeights<F>& lobes,
                               const Vec3<F>& wo,
                               const Vec3<F>& wi,
                               LobeShares<F>& out) {
    for (bool& known : out.is_known)
        known = false;
    const Vec3<F> h = normalize(wo + wi);
    const Vec3<F> fresnel = lobes.specular_f0 + lobes.specular_rise * schlick_weight(dot(wo, h));
    const F length_o = smith_length(wo.z, p.alpha);
    const F length_i = smith_length(wi.z, p.alpha);
    const F facets =
        ggx_distribution(h, p.alpha) * smith_visibility(wo.z, length_o, wi.z, length_i);
    static_assert(Lobes::index<Diffuse>() == 0);
    set_share(0, p.base_color * (lobes.diffuse * F(1.0f / pi_f)), MaskOf<F>(false), out);
    const MaskOf<F> singular = p.alpha <= F(min_ggx_alpha);
    set_share(Lobes::index<FacetReflection>(), fresnel * facets, singular, out);
    normalize_shares(out);
}

/// Adds one lobe's value, and dims those before it where it is a layer over them.
template <typename L, typename F>
OBSCURA_INLINE void share_lobe(const Reflection<F>& reflected,
                               const Transmission<F>& transmitted,
                               LobeShares<F>& out) {
    constexpr int k = Lobes::index<L>();
    const F zero(0.0f);
    out.is_known[k] = false;
    if constexpr (!L::always_exists) {
        if (!L::exists(reflected.p, reflected.w)) return;
    }
    const auto above = reflected.wi.z > zero;
    const MaskOf<F> singular = L::is_singular(reflected.p, reflected.w);
    if constexpr (L::place == LobePlace::transmitted) {
        const Vec3<F> value = L::evaluate(transmitted).value_cos;
        set_share(k, select(above, splat3(zero), value), singular, out);
    } else if constexpr (L::place == LobePlace::base) {
        const Vec3<F> value = L::evaluate(reflected).value_cos * reflected.wi.z;
        set_share(k, select(above, value, splat3(zero)), singular, out);
    } else {
        const LayerValue<F> layer = L::evaluate(reflected);
        for (int below = 0; below < k; ++below) {
            if (out.is_known[below])
                out.share[below] = out.share[below] * select(above, layer.passes, F(1.0f));
        }
        set_share(k, select(above, layer.value_cos, splat3(zero)), singular, out);
    }
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
                                  const Vec3<F>& wo,
                                  const Vec3<F>& wi,
                                  LobeShares<F>& out) {
    const Reflection<F> reflected{p, w, wo, wi, normalize(wo + wi)};
    const Transmission<F> transmitted{p, w, wo, wi, abs(wi.z)};
    share_lobes(Lobes{}, reflected, transmitted, out);
    normalize_shares(out);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
