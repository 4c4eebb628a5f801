// scene/scene.cpp - padding at the end of the scene's tables, and geometry stamps.
// SPDX-License-Identifier: Apache-2.0
#include "scene/scene.h"

#include <atomic>

namespace obscura {

GeometryStamp new_geometry_stamp() {
    static std::atomic<GeometryStamp> latest = 0;
    return ++latest;
}

void pad_tables(Scene& scene) {
    scene.positions.insert(scene.positions.end(), 4, 0.0f);
    scene.attributes.insert(scene.attributes.end(), 4, 0.0f);
    scene.indices.push_back(0);
}

}  // namespace obscura
