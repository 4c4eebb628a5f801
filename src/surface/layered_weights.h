// surface/layered_weights.h - how the lobes of a material share the light that arrives.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/lobes/list.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Lets the layers set their weights, the uppermost one first.
template <typename F, typename First, typename... Rest>
OBSCURA_INLINE void weigh_layers(LobeList<First, Rest...>,
                                 const LayeredParams<F>& p,
                                 const Vec3<F>& wo,
                                 LayeredWeights<F>& w) {
    if constexpr (sizeof...(Rest) > 0) weigh_layers(LobeList<Rest...>{}, p, wo, w);
    First::weigh(p, wo, w);
}

/// Lets the lobes below the layers set their weights, the last of the list first.
template <typename F, typename First, typename... Rest>
OBSCURA_INLINE void weigh_lobes(LobeList<First, Rest...>,
                                const LobeView<F>& view,
                                LayeredWeights<F>& w) {
    if constexpr (sizeof...(Rest) > 0) weigh_lobes(LobeList<Rest...>{}, view, w);
    if constexpr (First::place != LobePlace::layer) First::weigh(view, w);
}

/// The sum of one number for each of SampledLobes, added in the order of the first list.
template <typename F, typename... L>
OBSCURA_INLINE F sum_in_order(LobeList<L...>, const F (&numbers)[SampledLobes::count]) {
    return (... + numbers[SampledLobes::index<L>()]);
}

/// Sets the probabilities of the lobes.
template <typename F, typename... L>
OBSCURA_INLINE void set_probabilities(LobeList<L...>,
                                      const LobeView<F>& view,
                                      LayeredWeights<F>& w) {
    const LobeShare<F> shares[] = {L::share(view, w)...};
    const F light[] = {shares[SampledLobes::index<L>()].light...};
    const F sum = max(sum_in_order(ShareOrder{}, light), F(1e-6f));
    // What exists is tried now and then, for other directions than the mirrored one.
    const auto at_least = [&](const LobeShare<F>& share) {
        return select(share.exists, max(share.light / sum, F(0.05f)), F(0.0f));
    };
    const F wanted[] = {at_least(shares[SampledLobes::index<L>()])...};
    const F scale = F(1.0f) / max(sum_in_order(ProbabilityOrder{}, wanted), F(1e-6f));
    ((L::probability(w) = wanted[SampledLobes::index<L>()] * scale), ...);
}

/// Shares for one view direction, wo.z > 0.
///
/// Out     w: but for the probabilities. Returns what they follow from
template <typename F>
OBSCURA_INLINE LobeView<F> weigh_all(const LayeredParams<F>& p,
                                     const Vec3<F>& wo,
                                     LayeredWeights<F>& w) {
    weigh_layers(Lobes::At<LobePlace::layer, false>{}, p, wo, w);
    const LobeView<F> view{p, wo, facet_weights(p, wo)};
    weigh_lobes(Lobes{}, view, w);
    return view;
}

/// Shares and probabilities for one view direction, wo.z > 0.
template <typename F>
OBSCURA_INLINE LayeredWeights<F> layered_weights(const LayeredParams<F>& p, const Vec3<F>& wo) {
    LayeredWeights<F> w;
    const LobeView<F> view = weigh_all(p, wo, w);
    set_probabilities(SampledLobes{}, view, w);
    return w;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
