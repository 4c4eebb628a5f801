// surface/lobes/sheen.h - the sheen layer: fibres of cloth over the base.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/lobes/lobe.h"
#include "surface/sheen.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Diffuse draws its directions.
/// Source  KHR_materials_sheen; the lobe itself is in surface/sheen.h
struct Sheen : Lobe {
    static constexpr LobePlace place = LobePlace::layer;
    static constexpr ScatterEvent event{'R', 'G', "sheen"};
    static constexpr bool always_exists = false;
    static constexpr bool is_sampled = false;

    template <typename F>
    struct Params {
        Vec3<F> sheen_color;
        F sheen_alpha;
    };

    template <typename F>
    struct Weights {
        F unscaled_sheen;  ///< its albedo, see unscaled_sheen_albedo
        F below_sheen;
    };

    template <typename F>
    OBSCURA_INLINE static void weigh(const LayeredParams<F>& p,
                                     const Vec3<F>& wo,
                                     LayeredWeights<F>& w) {
        w.unscaled_sheen = F(0.0f);
        const F max_sheen = max_component(p.sheen_color);
        if (any(max_sheen > F(0.0f))) {
            w.unscaled_sheen = unscaled_sheen_albedo(wo.z, p.sheen_alpha);
        }
        w.below_sheen = F(1.0f) - max_sheen * albedo(w);
    }

    /// Towards wo, of a white sheen.
    template <typename F>
    OBSCURA_INLINE static F albedo(const LayeredWeights<F>& w) {
        return scaled_sheen_albedo(w.unscaled_sheen).albedo;
    }

    template <typename F>
    OBSCURA_INLINE static bool exists(const LayeredParams<F>& p, const LayeredWeights<F>&) {
        return any(max_component(p.sheen_color) > F(0.0f));
    }

    template <typename F>
    OBSCURA_INLINE static LayerValue<F> evaluate(const Reflection<F>& at) {
        const LayeredParams<F>& p = at.p;
        const F below_i =
            F(1.0f) - max_component(p.sheen_color) * sheen_albedo(at.wi.z, p.sheen_alpha).albedo;
        const F scale = scaled_sheen_albedo(at.w.unscaled_sheen).scale;
        const F sheen = scale * charlie_cos(at.wo.z, at.wi.z, at.h.z, p.sheen_alpha);
        return {p.sheen_color * sheen, F(0.0f), min(at.w.below_sheen, below_i)};
    }
};

}  // namespace OBSCURA_ISA
}  // namespace obscura
