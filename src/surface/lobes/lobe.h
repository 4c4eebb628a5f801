// surface/lobes/lobe.h - what every lobe of the layered material offers, and what lobes read.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/bsdf.h"
#include "surface/scatter_event.h"

#include <type_traits>

namespace obscura {
inline namespace OBSCURA_ISA {

/// Where a lobe stands in the material.
enum class LobePlace {
    base,         ///< reflects; the lobes of the base add up
    layer,        ///< reflects, and covers the base and the layers before it in the list
    transmitted,  ///< leads to the transmitted side; these lobes add up
};

template <typename F>
struct LayeredParams;
template <typename F>
struct LayeredWeights;

/// A lobe is a struct of static functions, in a header of its own, derived from this one, which
/// holds the defaults. lobes/list.h lists all lobes and has the recipe for one more; the loops over
/// the list are in layered_weights.h (shares and probabilities) and layered_bsdf.h (evaluation and
/// sampling).
///
///   LobePlace place
///   struct Params<F>, struct Weights<F>
///       What the lobe adds to LayeredParams and LayeredWeights.
///   weigh
///       Sets its Weights, but for the probability. Layers are weighed first, and of each kind the
///       last one of the list: a lobe finds the weights of all that cover it.
///         layer        void weigh(const LayeredParams<F>&, const Vec3<F>& wo, LayeredWeights<F>&)
///         others       void weigh(const LobeView<F>&, LayeredWeights<F>&)
///   bool exists(const LayeredParams<F>&, const LayeredWeights<F>&)
///       Whether any lane has the lobe; read where always_exists is false.
///   ScatterEvent event
///       What light path expressions call it where it is not singular.
///   MaskOf<F> is_singular(const LayeredParams<F>&, const LayeredWeights<F>&)
///       Where it is as narrow as lobes get: expressions then know it by the mode S.
///   evaluate
///       Value and density for one direction; the density holds the lobe's probability.
///         base         BsdfValue<F> evaluate(const Reflection<F>&), without the cosine of wi
///         layer        LayerValue<F> evaluate(const Reflection<F>&), times the cosine
///         transmitted  BsdfValue<F> evaluate(const Transmission<F>&), times the cosine
///
/// A lobe whose is_sampled is true has a probability and draws directions. Another lobe draws for
/// those where it is false, as it says there, and their density is 0 or counts with that lobe's.
///
///   LobeShare<F> share(const LobeView<F>&, const LayeredWeights<F>&)
///   F& probability(LayeredWeights<F>&), also for const weights
///   LobeSample<F> sample(const LobeDraw<F>&)
struct Lobe {
    static constexpr bool always_exists = true;
    static constexpr bool is_sampled = true;

    template <typename View, typename Weights>
    OBSCURA_INLINE static void weigh(const View&, Weights&) {}

    template <typename F>
    OBSCURA_INLINE static MaskOf<F> is_singular(const LayeredParams<F>&, const LayeredWeights<F>&) {
        return MaskOf<F>(false);
    }
};

/// What several lobes read of the material.
template <typename F>
struct BaseParams {
    Vec3<F> base_color;
    F metallic;
};

template <typename F>
struct FacetWeights;

/// What lobes share the light by.
template <typename F>
struct LobeView {
    const LayeredParams<F>& p;
    const Vec3<F>& wo;
    FacetWeights<F> facets;
};

/// About how much light a lobe sends on, which its probability follows.
template <typename F>
struct LobeShare {
    F light;
    MaskOf<F> exists;  ///< where it does, the lobe is chosen now and then, however little it sends
};

/// A pair of directions on the reflected side; what several lobes need is worked out once.
template <typename F>
struct Reflection {
    const LayeredParams<F>& p;
    const LayeredWeights<F>& w;
    const Vec3<F>& wo;
    const Vec3<F>& wi;
    Vec3<F> h;  ///< half vector
};

/// A pair of directions on two sides.
template <typename F>
struct Transmission {
    const LayeredParams<F>& p;
    const LayeredWeights<F>& w;
    const Vec3<F>& wo;
    const Vec3<F>& wi;
    F cosine;  ///< of wi, > 0
};

/// What a layer reflects, and what it leaves of the light from below.
template <typename F>
struct LayerValue {
    Vec3<F> value_cos;
    F pdf;
    F passes;
};

/// The numbers that a lobe draws a direction from.
template <typename F>
struct LobeDraw {
    const LayeredParams<F>& p;
    const LayeredWeights<F>& w;
    const Vec3<F>& wo;
    MaskOf<F> chosen;  ///< lanes that asked for this lobe
    Vec2<F> u;
    F event;  ///< chooses between the reflection and the transmission of one microfacet
};

/// Direction is any where a lobe cannot draw one: its density is then 0, or its side a wrong one.
template <typename F>
struct LobeSample {
    Vec3<F> direction;
    MaskOf<F> transmitted;  ///< on the transmitted side; what lies on the other one then ends
    F spread;               ///< how much the footprint widens: metres per metre
};

template <typename F>
OBSCURA_INLINE F channel_mean(const Vec3<F>& rgb) {
    return (rgb.x + rgb.y + rgb.z) * F(1.0f / 3);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
