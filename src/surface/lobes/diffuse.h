// surface/lobes/diffuse.h - Lambertian reflection of the base.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/lobes/sheen.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// How much the footprint widens where light leaves in all directions.
inline constexpr float diffuse_spread = 0.4f;

/// Draws the directions of the sheen, too, and counts its light in its share.
struct Diffuse : Lobe {
    static constexpr LobePlace place = LobePlace::base;
    static constexpr ScatterEvent event{'R', 'D', "diffuse"};

    template <typename F>
    struct Params {};

    template <typename F>
    struct Weights {
        F diffuse;  ///< what neither reflects at the dielectric boundary nor passes it
        F p_diffuse;
    };

    template <typename F>
    OBSCURA_INLINE static void weigh(const LobeView<F>& view, LayeredWeights<F>& w) {
        const F one(1.0f);
        const F dielectric = one - view.p.metallic;
        w.diffuse = dielectric * (one - view.p.transmission) * (one - view.facets.boundary);
    }

    template <typename F>
    OBSCURA_INLINE static BsdfValue<F> evaluate(const Reflection<F>& at) {
        const F reflected = F(1.0f) - at.p.diffuse_transmission;
        return {at.p.base_color * (at.w.diffuse * reflected * F(1.0f / pi_f)),
                at.w.p_diffuse * at.wi.z * F(1.0f / pi_f)};
    }

    template <typename F>
    OBSCURA_INLINE static LobeShare<F> share(const LobeView<F>& view, const LayeredWeights<F>& w) {
        const LayeredParams<F>& p = view.p;
        const F below = w.below_coat * w.below_sheen;
        const F light =
            below * w.diffuse * (F(1.0f) - p.diffuse_transmission) * luminance(p.base_color) +
            w.below_coat * luminance(p.sheen_color) * Sheen::albedo(w);
        return {light, light > F(rounding_share)};
    }

    template <typename Weights>
    OBSCURA_INLINE static auto& probability(Weights& w) {
        return w.p_diffuse;
    }

    template <typename F>
    OBSCURA_INLINE static LobeSample<F> sample(const LobeDraw<F>& draw) {
        return {cosine_hemisphere(draw.u), MaskOf<F>(false), F(diffuse_spread)};
    }

    /// A share of light up to this is the rounding of what other layers take.
    static constexpr float rounding_share = 1e-7f;
};

}  // namespace OBSCURA_ISA
}  // namespace obscura
