// gltf/scene_warnings.cpp - warnings about a scene as a whole.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/scene_warnings.h"

#include <algorithm>

namespace obscura::gltf {

void warn_about_whole(const Document& document, const Scene& scene, Log& log) {
    if (scene.bounds.empty()) {
        log.warn(document.file,
                 "the scene has no triangles, shapes, points, lines or splats; only its "
                 "surroundings will "
                 "be seen");
        return;
    }
    const Vec3f extent = scene.bounds.high - scene.bounds.low;
    const float farthest =
        std::max(max_component(abs(scene.bounds.low)), max_component(abs(scene.bounds.high)));
    constexpr float coarse = 1e5f;  // single precision then has steps of 1/160 of the extent
    if (farthest > coarse * max_component(extent)) {
        log.warn(document.file,
                 "the scene lies so far from the origin, for its size, that positions lose "
                 "precision");
    }
    constexpr float smallest_m = 1e-6f;
    constexpr float largest_m = 1e12f;
    const float size = max_component(extent);
    if ((size > 0 && size < smallest_m) || farthest > largest_m) {
        log.warn(
            document.file,
            "the scene is smaller than 1e-6 m or reaches further than 1e12 m: single precision "
            "finds wrong hits and light there; a scale on its root nodes helps");
    }
}

}  // namespace obscura::gltf
