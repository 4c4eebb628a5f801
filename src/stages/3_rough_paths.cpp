// stages/3_rough_paths.cpp - smooth lobes where paths meet them that have scattered roughly before.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_rough_paths.h"

#include "surface/layered_weights.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

OBSCURA_INLINE Lanes widened(Mask rough, Lanes width) {
    const Lanes wide =
        clamp(width * Lanes(2.0f), Lanes(1.0f / 3 * min_rough_width), Lanes(min_rough_width));
    return select(rough & (width < Lanes(min_rough_width)), wide, width);
}

void regularize_layers(const RoughPathHit& hit, LayeredPoint& point) {
    LayeredParams<Lanes>& p = point.params;
    const LayeredWeights<Lanes>& w = point.weights;
    const Mask thin_wall = (!p.solid) & is_smooth(w.through_alpha) & (w.transmitted > Lanes(0.0f));
    const Mask rough = hit.rough & point.layered & (!thin_wall);
    if (none(rough)) return;
    p.alpha = {widened(rough, p.alpha.x), widened(rough, p.alpha.y)};
    p.coat_alpha = widened(rough, p.coat_alpha);
    point.weights = layered_weights(p, hit.wo);
}

template <typename... L>
OBSCURA_INLINE Lanes sum_of_probabilities(LobeList<L...>, const LayeredWeights<Lanes>& w) {
    return (... + L::probability(w));
}

template <typename... L>
OBSCURA_INLINE void scale_probabilities(LobeList<L...>, Lanes scale, LayeredWeights<Lanes>& w) {
    ((L::probability(w) = L::probability(w) * scale), ...);
}

void remove_smooth_layers(Mask rough, LayeredPoint& point) {
    const Lanes zero(0.0f);
    const LayeredParams<Lanes>& p = point.params;
    LayeredWeights<Lanes>& w = point.weights;
    const Lanes before = sum_of_probabilities(SampledLobes{}, w);
    const Lanes smooth_square(min_rough_width * min_rough_width);
    const Mask facets = rough & point.layered & (p.alpha.x * p.alpha.y < smooth_square);
    w.dielectric = select(facets, splat3(zero), w.dielectric);
    w.metal = select(facets, splat3(zero), w.metal);
    w.p_facet = select(facets, zero, w.p_facet);
    w.transmitted = select(facets, zero, w.transmitted);
    w.through_factor = select(facets, zero, w.through_factor);
    w.reflects = select(facets, Lanes(1.0f), w.reflects);
    w.facetwise = w.facetwise & (!facets);
    const Mask coat = rough & point.layered & (p.coat_alpha < Lanes(min_rough_width));
    w.coat_factor = select(coat, zero, w.coat_factor);
    w.p_coat = select(coat, zero, w.p_coat);
    const Lanes after = sum_of_probabilities(SampledLobes{}, w);
    const Lanes scale = before / max(after, Lanes(1e-6f));
    scale_probabilities(SampledLobes{}, select(facets | coat, scale, Lanes(1.0f)), w);
}

}  // namespace

void regularize(RoughPathHit& hit, LayeredPoint* layers) {
    hit.bsdf.alpha = widened(hit.rough, hit.bsdf.alpha);
    hit.lobes = lobe_weights(hit.bsdf, hit.wo.z);
    if (layers != nullptr) regularize_layers(hit, *layers);
}

void remove_smooth_lobes(RoughPathHit& hit, LayeredPoint* layers) {
    const Lanes zero(0.0f);
    const Mask smooth = hit.rough & (hit.bsdf.alpha < Lanes(min_rough_width));
    LobeWeights<Lanes>& w = hit.lobes;
    w.specular_f0 = select(smooth, splat3(zero), w.specular_f0);
    w.specular_rise = select(smooth, splat3(zero), w.specular_rise);
    w.specular_probability = select(smooth, zero, w.specular_probability);
    if (layers != nullptr) remove_smooth_layers(hit.rough, *layers);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
