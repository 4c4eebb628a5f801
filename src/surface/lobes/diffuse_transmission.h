// surface/lobes/diffuse_transmission.h - Lambertian transmission of leaves and paper.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/lobes/diffuse.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Source  KHR_materials_diffuse_transmission: a part of what would be diffuse
struct DiffuseTransmission : Lobe {
    static constexpr LobePlace place = LobePlace::transmitted;
    static constexpr ScatterEvent event{'T', 'D', "diffuse_transmission"};

    template <typename F>
    struct Params {
        F diffuse_transmission;
        Vec3<F> diffuse_transmission_color;
    };

    template <typename F>
    struct Weights {
        F p_diffuse_transmission;
    };

    template <typename F>
    OBSCURA_INLINE static BsdfValue<F> evaluate(const Transmission<F>& at) {
        const F part = at.w.diffuse * at.p.diffuse_transmission;
        return {at.p.diffuse_transmission_color * (part * at.cosine * F(1.0f / pi_f)),
                at.w.p_diffuse_transmission * at.cosine * F(1.0f / pi_f)};
    }

    template <typename F>
    OBSCURA_INLINE static LobeShare<F> share(const LobeView<F>& view, const LayeredWeights<F>& w) {
        const LayeredParams<F>& p = view.p;
        const F below = w.below_coat * w.below_sheen;
        const F light =
            below * w.diffuse * p.diffuse_transmission * luminance(p.diffuse_transmission_color);
        return {light, light > F(Diffuse::rounding_share)};
    }

    template <typename Weights>
    OBSCURA_INLINE static auto& probability(Weights& w) {
        return w.p_diffuse_transmission;
    }

    template <typename F>
    OBSCURA_INLINE static LobeSample<F> sample(const LobeDraw<F>& draw) {
        const Vec3<F> reflected = cosine_hemisphere(draw.u);
        return {{reflected.x, reflected.y, -reflected.z}, MaskOf<F>(true), F(diffuse_spread)};
    }
};

}  // namespace OBSCURA_ISA
}  // namespace obscura
