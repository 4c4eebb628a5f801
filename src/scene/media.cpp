// scene/media.cpp - numbers the media inside meshes by their priority, for nested dielectrics.
// SPDX-License-Identifier: Apache-2.0
#include "scene/media.h"

#include <algorithm>

namespace obscura {

namespace {

Medium medium_of(const MaterialLayers& dielectric) {
    Medium out;
    for (size_t i = 0; i < 3; ++i) {
        out.extinction[i] = dielectric.attenuation[i];
        out.albedo[i] = dielectric.scatter_albedo[i];
    }
    out.ior = dielectric.ior > 0.0F ? dielectric.ior : 1.5F;
    out.anisotropy = dielectric.scatter_anisotropy;
    return out;
}

}  // namespace

int32_t medium_of(const Scene& scene, const Primitive& primitive) {
    const int32_t layers = scene.materials[static_cast<size_t>(primitive.material)].layers;
    return layers < 0 ? 0 : scene.layers[static_cast<size_t>(layers)].medium;
}

void number_media(Scene& scene) {
    std::vector<MaterialLayers*> dielectrics;
    for (MaterialLayers& layers : scene.layers) {
        if (layers.medium != 0) dielectrics.push_back(&layers);
    }
    std::stable_sort(dielectrics.begin(), dielectrics.end(), [](const auto* a, const auto* b) {
        return a->ior < b->ior;
    });
    scene.media.assign(1, Medium{});  // number 0: air
    for (MaterialLayers* dielectric : dielectrics) {
        if (scene.media.size() <= max_media) {
            scene.media.push_back(medium_of(*dielectric));
        }
        dielectric->medium = static_cast<int32_t>(scene.media.size()) - 1;
    }
}

}  // namespace obscura
