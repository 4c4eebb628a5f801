// gltf/geometry/cofactors.h - the matrix that transforms normals.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/transform.h"

namespace obscura::gltf {

/// Adjugate transposed: determinant times the inverse transpose, without a division.
inline Affined cofactors(const Affined& a) {
    const auto& m = a.m;
    Affined out;
    for (size_t r = 0; r < 3; ++r) {
        const size_t r1 = (r + 1) % 3;
        const size_t r2 = (r + 2) % 3;
        for (size_t c = 0; c < 3; ++c) {
            const size_t c1 = (c + 1) % 3;
            const size_t c2 = (c + 2) % 3;
            out.m[r][c] = m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
        }
    }
    return out;
}

}  // namespace obscura::gltf
