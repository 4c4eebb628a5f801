// scene/media.cpp - numbers the bodies that light travels through, by precedence.
// SPDX-License-Identifier: Apache-2.0
#include "scene/media.h"

#include <algorithm>

namespace obscura {

namespace {

Medium medium_of(const MaterialLayers& body) {
    Medium out;
    for (size_t i = 0; i < 3; ++i) {
        out.extinction[i] = body.attenuation[i];
        out.albedo[i] = body.scatter_albedo[i];
    }
    out.ior = body.ior > 0.0F ? body.ior : 1.5F;
    out.anisotropy = body.scatter_anisotropy;
    return out;
}

}  // namespace

int32_t medium_of(const Scene& scene, const Primitive& primitive) {
    const int32_t layers = scene.materials[static_cast<size_t>(primitive.material)].layers;
    return layers < 0 ? 0 : scene.layers[static_cast<size_t>(layers)].medium;
}

void number_media(Scene& scene) {
    std::vector<MaterialLayers*> bodies;
    for (MaterialLayers& layers : scene.layers) {
        if (layers.medium != 0) bodies.push_back(&layers);
    }
    std::stable_sort(
        bodies.begin(), bodies.end(), [](const auto* a, const auto* b) { return a->ior < b->ior; });
    scene.media.assign(1, Medium{});  // number 0: air
    for (MaterialLayers* body : bodies) {
        if (scene.media.size() <= most_media) {
            scene.media.push_back(medium_of(*body));
        }
        body->medium = static_cast<int32_t>(scene.media.size()) - 1;
    }
}

}  // namespace obscura
