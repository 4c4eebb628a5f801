// math/transform.h - affine transforms as 3x4 matrices.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"

namespace obscura {

/// x -> linear part * x + translation. Row-major: m[row][column], column 3 is the translation.
/// Names read right to left: world_from_object.
template <typename F>
struct Affine {
    F m[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
};

using Affinef = Affine<float>;
using Affined = Affine<double>;

inline namespace OBSCURA_ISA {

template <typename F>
OBSCURA_INLINE Vec3<F> transform_point(const Affine<F>& a, const Vec3<F>& p) {
    return {a.m[0][0] * p.x + a.m[0][1] * p.y + a.m[0][2] * p.z + a.m[0][3],
            a.m[1][0] * p.x + a.m[1][1] * p.y + a.m[1][2] * p.z + a.m[1][3],
            a.m[2][0] * p.x + a.m[2][1] * p.y + a.m[2][2] * p.z + a.m[2][3]};
}

template <typename F>
OBSCURA_INLINE Vec3<F> transform_vector(const Affine<F>& a, const Vec3<F>& v) {
    return {a.m[0][0] * v.x + a.m[0][1] * v.y + a.m[0][2] * v.z,
            a.m[1][0] * v.x + a.m[1][1] * v.y + a.m[1][2] * v.z,
            a.m[2][0] * v.x + a.m[2][1] * v.y + a.m[2][2] * v.z};
}

/// Maps a normal, given the INVERSE of the map that moves points: n' = transpose(inverse) * n.
/// Not normalised.
template <typename F>
OBSCURA_INLINE Vec3<F> transform_normal(const Affine<F>& inverse, const Vec3<F>& n) {
    return {inverse.m[0][0] * n.x + inverse.m[1][0] * n.y + inverse.m[2][0] * n.z,
            inverse.m[0][1] * n.x + inverse.m[1][1] * n.y + inverse.m[2][1] * n.z,
            inverse.m[0][2] * n.x + inverse.m[1][2] * n.y + inverse.m[2][2] * n.z};
}

/// The transform that applies b first, then a.
template <typename F>
OBSCURA_INLINE Affine<F> compose(const Affine<F>& a, const Affine<F>& b) {
    Affine<F> out;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c) {
            out.m[r][c] = a.m[r][0] * b.m[0][c] + a.m[r][1] * b.m[1][c] + a.m[r][2] * b.m[2][c];
        }
        out.m[r][3] = out.m[r][3] + a.m[r][3];
    }
    return out;
}

/// Determinant of the linear part; negative for a mirror.
template <typename F>
OBSCURA_INLINE F determinant(const Affine<F>& a) {
    const auto& m = a.m;
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/// Inverse map; the caller has checked that determinant(a) is not zero.
template <typename F>
OBSCURA_INLINE Affine<F> inverse(const Affine<F>& a) {
    const auto& m = a.m;
    const F s = F(1) / determinant(a);
    Affine<F> out;
    out.m[0][0] = (m[1][1] * m[2][2] - m[1][2] * m[2][1]) * s;
    out.m[0][1] = (m[0][2] * m[2][1] - m[0][1] * m[2][2]) * s;
    out.m[0][2] = (m[0][1] * m[1][2] - m[0][2] * m[1][1]) * s;
    out.m[1][0] = (m[1][2] * m[2][0] - m[1][0] * m[2][2]) * s;
    out.m[1][1] = (m[0][0] * m[2][2] - m[0][2] * m[2][0]) * s;
    out.m[1][2] = (m[0][2] * m[1][0] - m[0][0] * m[1][2]) * s;
    out.m[2][0] = (m[1][0] * m[2][1] - m[1][1] * m[2][0]) * s;
    out.m[2][1] = (m[0][1] * m[2][0] - m[0][0] * m[2][1]) * s;
    out.m[2][2] = (m[0][0] * m[1][1] - m[0][1] * m[1][0]) * s;
    for (int r = 0; r < 3; ++r) {
        out.m[r][3] = -(out.m[r][0] * m[0][3] + out.m[r][1] * m[1][3] + out.m[r][2] * m[2][3]);
    }
    return out;
}

/// Converts between precisions.
template <typename To, typename From>
Affine<To> affine_cast(const Affine<From>& a) {
    Affine<To> out;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c)
            out.m[r][c] = static_cast<To>(a.m[r][c]);
    }
    return out;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
