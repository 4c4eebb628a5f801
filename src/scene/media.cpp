// scene/media.cpp - numbers the bodies that light travels through, by precedence.
// SPDX-License-Identifier: Apache-2.0
#include "scene/media.h"

#include <algorithm>

namespace obscura {

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
            scene.media.push_back({{body->absorption[0], body->absorption[1], body->absorption[2]},
                                   body->ior > 0.0F ? body->ior : 1.5F});
        }
        body->medium = static_cast<int32_t>(scene.media.size()) - 1;
    }
}

}  // namespace obscura
