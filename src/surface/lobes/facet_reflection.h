// surface/lobes/facet_reflection.h - microfacet reflection: metal, dielectric, thin film.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/lobes/facet_transmission.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// Metal and dielectric mixed, stretched along the tangent where it is anisotropic. Where the
/// facets also transmit, a microfacet is drawn first, then whether it reflects: one probability and
/// one sample() serve FacetTransmission, too.
///
/// Source  glTF 2.0, Appendix B; KHR_materials_specular, _ior, _iridescence, _anisotropy
struct FacetReflection : Lobe {
    static constexpr LobePlace place = LobePlace::base;
    static constexpr ScatterEvent event{'R', 'G', "specular"};

    template <typename F>
    struct Params {
        GgxWidths<F> alpha;  ///< along the shading frame's tangent and bitangent
        Vec3<F> f0;          ///< of the dielectric, at normal incidence
        F f90;               ///< of the dielectric, at grazing incidence
        ThinFilm<F> thin_film;
    };

    template <typename F>
    struct Weights {
        Vec3<F> dielectric;  ///< scales the dielectric's facets, its share included
        Vec3<F> metal;       ///< scales the metal's facets, its share included
        F p_facet;           ///< of reflection and transmission together
    };

    template <typename F>
    OBSCURA_INLINE static void weigh(const LobeView<F>& view, LayeredWeights<F>& w) {
        w.dielectric = view.facets.dielectric_factor * (F(1.0f) - view.p.metallic);
        w.metal = view.facets.metal_factor * view.p.metallic;
    }

    template <typename F>
    OBSCURA_INLINE static MaskOf<F> is_singular(const LayeredParams<F>& p,
                                                const LayeredWeights<F>&) {
        return is_smooth(p.alpha);
    }

    template <typename F>
    OBSCURA_INLINE static BsdfValue<F> evaluate(const Reflection<F>& at) {
        const LayeredParams<F>& p = at.p;
        const LayeredWeights<F>& w = at.w;
        const LayeredFresnel<F> fresnel = layered_fresnel(p, dot(at.wo, at.h));
        const Vec3<F> reflectance = facet_reflectance(w, fresnel);
        F by_facet = w.p_facet;
        if (any(w.transmitted > F(0.0f))) by_facet = by_facet * facet_reflects(p, w, fresnel);
        const F length_o = smith_length(at.wo, p.alpha);
        const F distribution = ggx_distribution(at.h, p.alpha);
        const F specular =
            distribution *
            smith_visibility(at.wo.z, length_o, at.wi.z, smith_length(at.wi, p.alpha));
        return {reflectance * specular, by_facet * distribution * F(0.5f) / (at.wo.z + length_o)};
    }

    template <typename F>
    OBSCURA_INLINE static LobeShare<F> share(const LobeView<F>& view, const LayeredWeights<F>& w) {
        const LayeredParams<F>& p = view.p;
        const FacetWeights<F>& s = view.facets;
        const F zero(0.0f);
        const F one(1.0f);
        const F color = luminance(p.base_color);
        const F reflected = luminance(s.fresnel.dielectric);
        const F below = w.below_coat * w.below_sheen;
        const F specular = below * ((one - p.metallic) * max(s.boundary, reflected) +
                                    p.metallic * luminance(s.fresnel.metal));
        const F passes = select(p.solid, w.transmitted * (one - reflected), w.transmitted);
        const F transmitted = below * passes * color;
        const MaskOf<F> exists((specular > zero) | (w.transmitted * color > zero));
        return {specular + transmitted, exists};
    }

    template <typename Weights>
    OBSCURA_INLINE static auto& probability(Weights& w) {
        return w.p_facet;
    }

    template <typename F>
    OBSCURA_INLINE static LobeSample<F> sample(const LobeDraw<F>& draw) {
        const LayeredParams<F>& p = draw.p;
        const LayeredWeights<F>& w = draw.w;
        GgxWidths<F> alpha = p.alpha;
        const auto may_pass = draw.chosen & (w.transmitted > F(0.0f));
        if (any(may_pass & (!w.facetwise))) {
            const auto passes = may_pass & (!w.facetwise) & (draw.event >= w.reflects);
            alpha = {select(passes, w.through_alpha.x, alpha.x),
                     select(passes, w.through_alpha.y, alpha.y)};
        }
        const Vec3<F> h = sample_visible_normal(draw.wo, alpha, draw.u);
        const F cosine = dot(draw.wo, h);
        LobeSample<F> drawn{h * (F(2.0f) * cosine) - draw.wo,
                            MaskOf<F>(false),
                            F(0.5f) * sqrt(p.alpha.x * p.alpha.y)};
        if (any(may_pass)) {
            const F reflects = facet_reflects(p, w, layered_fresnel(p, cosine));
            drawn.transmitted = draw.event >= reflects;
            drawn.direction = select(drawn.transmitted, transmit(p, draw.wo, h), drawn.direction);
        }
        return drawn;
    }
};

}  // namespace OBSCURA_ISA
}  // namespace obscura
