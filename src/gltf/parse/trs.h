// gltf/parse/trs.h - a transform from translation, rotation and scale.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document_animation.h"
#include "math/transform.h"

#include <array>
#include <cmath>

namespace obscura::gltf {

/// Scale, then rotation, then translation: glTF 2.0 section 3.5.2. The quaternion (x, y, z, w) is
/// unit.
inline Affined affine_from_trs(const std::array<double, 3>& t,
                               const std::array<double, 4>& q,
                               const std::array<double, 3>& s) {
    const auto [x, y, z, w] = q;
    const double rotation[3][3] = {
        {1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
        {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
        {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    Affined out;
    for (size_t r = 0; r < 3; ++r) {
        for (size_t c = 0; c < 3; ++c)
            out.m[r][c] = rotation[r][c] * s[c];
        out.m[r][3] = t[r];
    }
    return out;
}

inline Affined affine_from_trs(const GltfTrs& trs) {
    return affine_from_trs(trs.translation, trs.rotation, trs.scale);
}

/// Brings a quaternion to length 1; returns false when it has none.
inline bool normalize_quaternion(std::array<double, 4>& q) {
    const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
    if (!(length > 0) || !std::isfinite(length)) return false;
    for (double& component : q)
        component /= length;
    return true;
}

}  // namespace obscura::gltf
