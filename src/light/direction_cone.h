// light/direction_cone.h - a cone of directions, and the cone around two of them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"
#include "math/warp.h"

#include <algorithm>
#include <cmath>

namespace obscura {

struct DirectionCone {
    Vec3f axis{0, 0, 1};   ///< unit
    float half_angle = 0;  ///< in [0, pi]; pi: all directions
};

/// The narrowest cone around two cones.
///
/// Source  Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree
///         Splitting", HPG 2018, algorithm 1
inline DirectionCone join(const DirectionCone& a, const DirectionCone& b) {
    const DirectionCone& wide = a.half_angle >= b.half_angle ? a : b;
    const DirectionCone& narrow = a.half_angle >= b.half_angle ? b : a;
    const Vec3f across = cross(wide.axis, narrow.axis);
    const float cosine = dot(wide.axis, narrow.axis);
    const float apart = std::atan2(length(across), cosine);
    if (apart + narrow.half_angle <= wide.half_angle) return wide;
    const float half_angle = 0.5f * (wide.half_angle + apart + narrow.half_angle);
    const Vec3f towards = narrow.axis - wide.axis * cosine;
    if (half_angle >= pi_f || !(dot(towards, towards) > 0)) return {wide.axis, pi_f};
    const float turn = half_angle - wide.half_angle;
    const Vec3f axis = wide.axis * std::cos(turn) + normalize(towards) * std::sin(turn);
    return {normalize(axis), half_angle};
}

}  // namespace obscura
