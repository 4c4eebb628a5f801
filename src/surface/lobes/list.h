// surface/lobes/list.h - the list of all lobes, and the material and weights that they make up.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/lobes/coat.h"
#include "surface/lobes/diffuse.h"
#include "surface/lobes/diffuse_transmission.h"
#include "surface/lobes/facet_reflection.h"
#include "surface/lobes/facet_transmission.h"
#include "surface/lobes/sheen.h"

namespace obscura {
inline namespace OBSCURA_ISA {

template <typename... L>
struct LobeList;

namespace lobes {

template <typename... Lists>
struct Join;
template <typename... A>
struct Join<LobeList<A...>> {
    using Type = LobeList<A...>;
};
template <typename... A, typename... B, typename... Rest>
struct Join<LobeList<A...>, LobeList<B...>, Rest...> : Join<LobeList<A..., B...>, Rest...> {};

template <bool kept, typename L>
using Kept = std::conditional_t<kept, LobeList<L>, LobeList<>>;

template <typename L, typename... All>
inline constexpr bool is_one_of = (std::is_same_v<L, All> || ...);

}  // namespace lobes

/// Types of lobes, and the parts of the list that the loops go over.
template <typename... L>
struct LobeList {
    static constexpr int count = sizeof...(L);

    using Sampled = typename lobes::Join<LobeList<>, lobes::Kept<L::is_sampled, L>...>::Type;

    template <LobePlace place, bool always_exist>
    using At = typename lobes::Join<
        LobeList<>,
        lobes::Kept<L::place == place && L::always_exists == always_exist, L>...>::Type;

    /// The same lobes, some of them first.
    template <typename... First>
    using Beginning = typename lobes::Join<LobeList<First...>,
                                           lobes::Kept<!lobes::is_one_of<L, First...>, L>...>::Type;

    /// A lobe's number in the list.
    template <typename Wanted>
    static constexpr int index() {
        int n = 0;
        int found = count;
        ((found = std::is_same_v<L, Wanted> ? n : found, ++n), ...);
        return found;
    }
};

/// All lobes: the base and what is transmitted, then the layers from the lowest to the uppermost.
///
/// To add a lobe:
///  1. surface/lobes/<name>.h: a struct derived from Lobe with the functions that lobe.h describes,
///     always_exists false. Where its Params are 0 it sends nothing on and its share is 0. Its
///     `event` is what light path expressions call it; a new label needs its components in
///     film/light_components.cpp, or no layer has its light, and a word in docs/layers.md.
///  2. Here: its include and its place in Lobes. Its Params and Weights join LayeredParams and
///     LayeredWeights, its probability the sums, by themselves.
///  3. Its reader: a function of stages/3_layers.cpp that fills its Params for each hit. New
///     numbers and textures are members of MaterialLayers: surface/material_layers.h says which
///     places read them from glTF.
///  4. What knows the lobes one by one: surface/surface_albedo.h (the layer `albedo`),
///     ambient_layers of stages/3_raycast.cpp, and takes_rest of surface/lobe_shares.h, which is
///     true of one lobe in each lane. A layer takes its part of what lies below it, beside
///     below_coat and below_sheen, in layered_bsdf.h, lobe_shares.h, straight_transmission.h and
///     the lobes of the base.
///  5. Its test: a case in tests/statistics/layered_bsdf_test.cpp and one in
///     tests/surface/layered_bsdf_test.cpp; its Params in tests/support/layered_materials.h.
using Lobes =
    LobeList<Diffuse, DiffuseTransmission, FacetTransmission, FacetReflection, Sheen, Coat>;

using SampledLobes = Lobes::Sampled;

/// The orders in which shares and probabilities are added up. Another order would change the last
/// bits of images; a lobe that is not named here comes last.
using ShareOrder = SampledLobes::Beginning<FacetReflection, Diffuse, DiffuseTransmission, Coat>;
using ProbabilityOrder =
    SampledLobes::Beginning<Diffuse, FacetReflection, Coat, DiffuseTransmission>;

namespace lobes {

template <typename F, typename List>
struct ParamsOf;
template <typename F, typename... L>
struct ParamsOf<F, LobeList<L...>> : L::template Params<F>... {};

template <typename F, typename List>
struct WeightsOf;
template <typename F, typename... L>
struct WeightsOf<F, LobeList<L...>> : L::template Weights<F>... {};

}  // namespace lobes

/// A surface point's material with all layers, all textures applied, as seen from one side.
template <typename F>
struct LayeredParams : BaseParams<F>, lobes::ParamsOf<F, Lobes> {};

/// What depends on the view direction only: how the layers share the light. The factors of facets
/// hold what light gains that they reflect or refract more than once (interreflection). The
/// probabilities p_... are of sample_layered's lobes, sum 1.
template <typename F>
struct LayeredWeights : lobes::WeightsOf<F, Lobes> {};

}  // namespace OBSCURA_ISA
}  // namespace obscura
