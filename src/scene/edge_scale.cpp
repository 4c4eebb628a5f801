// scene/edge_scale.cpp - a scale that keeps products of edges in the range of single precision.
// SPDX-License-Identifier: Apache-2.0
#include "scene/edge_scale.h"

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

template <typename Floats>
float farthest(const Floats& coordinates, float out) {
    for (const float x : coordinates)
        out = std::max(out, std::fabs(x));
    return out;
}

}  // namespace

float edge_scale(const Scene& scene) {
    constexpr float min_reach = 1e-3f;
    constexpr float max_reach = 1e6f;
    const float reach = farthest(scene.motion.positions, farthest(scene.positions, 0.0f));
    if (reach == 0.0f || (reach >= min_reach && reach <= max_reach)) return 1.0f;
    const int wanted = reach > max_reach ? std::ilogb(max_reach) : 0;
    return std::ldexp(1.0f, wanted - std::ilogb(reach));
}

}  // namespace obscura
