// gltf/parse/trs.h - a transform from translation, rotation and scale.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document_animation.h"
#include "math/transform.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

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

/// The rotation of a matrix whose columns are unit and at right angles, as a unit quaternion.
///
/// Source  S. W. Shepperd, "Quaternion from rotation matrix", J. Guidance and Control 1, 1978: by
///         the largest of the four components, so that none is a difference of nearly equal numbers
inline std::array<double, 4> quaternion_of(const double (&m)[3][3]) {
    const double squares[4] = {1 + m[0][0] - m[1][1] - m[2][2],
                               1 - m[0][0] + m[1][1] - m[2][2],
                               1 - m[0][0] - m[1][1] + m[2][2],
                               1 + m[0][0] + m[1][1] + m[2][2]};
    const auto largest = static_cast<size_t>(std::max_element(squares, squares + 4) - squares);
    const double twice = std::sqrt(squares[largest]);
    const double factor = 0.5 / twice;
    std::array<double, 4> out{};
    out[largest] = 0.5 * twice;
    if (largest == 3) {
        out[0] = (m[2][1] - m[1][2]) * factor;
        out[1] = (m[0][2] - m[2][0]) * factor;
        out[2] = (m[1][0] - m[0][1]) * factor;
        return out;
    }
    const size_t next = (largest + 1) % 3;
    const size_t last = (largest + 2) % 3;
    out[next] = (m[next][largest] + m[largest][next]) * factor;
    out[last] = (m[last][largest] + m[largest][last]) * factor;
    out[3] = (m[last][next] - m[next][last]) * factor;
    return out;
}

/// The parts of a transform, a mirror as a negative scale along x; nothing where it shears or
/// flattens.
inline std::optional<GltfTrs> trs_of(const Affined& a) {
    constexpr double tolerance = 1e-6;
    GltfTrs out;
    double rotation[3][3];
    for (size_t c = 0; c < 3; ++c) {
        out.translation[c] = a.m[c][3];
        out.scale[c] = std::hypot(a.m[0][c], a.m[1][c], a.m[2][c]);
        if (!(out.scale[c] > 0) || !std::isfinite(out.scale[c])) return std::nullopt;
    }
    if (determinant(a) < 0) out.scale[0] = -out.scale[0];
    for (size_t c = 0; c < 3; ++c) {
        for (size_t r = 0; r < 3; ++r)
            rotation[r][c] = a.m[r][c] / out.scale[c];
    }
    for (size_t c = 0; c < 3; ++c) {
        const size_t other = (c + 1) % 3;
        double cosine = 0;
        for (const auto& row : rotation)
            cosine += row[c] * row[other];
        if (std::abs(cosine) > tolerance) return std::nullopt;
    }
    out.rotation = quaternion_of(rotation);
    return out;
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
