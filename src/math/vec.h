// math/vec.h - two- and three-component vectors over any value type F (float, double, Lanes).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/lanes.h"

namespace obscura {

template <typename F>
struct Vec2 {
    F x, y;
};

template <typename F>
struct Vec3 {
    F x, y, z;
};

using Vec2f = Vec2<float>;
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

inline namespace OBSCURA_ISA {

// clang-format off
template <typename F> OBSCURA_INLINE Vec2<F> operator+(const Vec2<F>& a, const Vec2<F>& b) {
    return {a.x + b.x, a.y + b.y};
}
template <typename F> OBSCURA_INLINE Vec2<F> operator-(const Vec2<F>& a, const Vec2<F>& b) {
    return {a.x - b.x, a.y - b.y};
}
template <typename F> OBSCURA_INLINE Vec2<F> operator*(const Vec2<F>& a, const F& s) {
    return {a.x * s, a.y * s};
}

template <typename F> OBSCURA_INLINE Vec3<F> operator+(const Vec3<F>& a, const Vec3<F>& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <typename F> OBSCURA_INLINE Vec3<F> operator-(const Vec3<F>& a, const Vec3<F>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <typename F> OBSCURA_INLINE Vec3<F> operator*(const Vec3<F>& a, const Vec3<F>& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <typename F> OBSCURA_INLINE Vec3<F> operator*(const Vec3<F>& a, const F& s) {
    return {a.x * s, a.y * s, a.z * s};
}
template <typename F> OBSCURA_INLINE Vec3<F> operator*(const F& s, const Vec3<F>& a) {
    return {a.x * s, a.y * s, a.z * s};
}
template <typename F> OBSCURA_INLINE Vec3<F> operator-(const Vec3<F>& a) {
    return {-a.x, -a.y, -a.z};
}
// clang-format on

template <typename F>
OBSCURA_INLINE F dot(const Vec3<F>& a, const Vec3<F>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <typename F>
OBSCURA_INLINE Vec3<F> cross(const Vec3<F>& a, const Vec3<F>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <typename F>
OBSCURA_INLINE F length(const Vec3<F>& a) {
    return sqrt(dot(a, a));
}

/// Unit vector along a. Zero and underflowing vectors give zero; vectors above 1e19 give too short
/// ones.
template <typename F>
OBSCURA_INLINE Vec3<F> normalize(const Vec3<F>& a) {
    return a * inverse_sqrt(clamp(dot(a, a), F(1e-36f), F(3e38f)));
}

template <typename F>
OBSCURA_INLINE Vec3<F> splat3(const F& value) {
    return {value, value, value};
}

template <typename F, typename M>
OBSCURA_INLINE Vec3<F> select(const M& mask, const Vec3<F>& a, const Vec3<F>& b) {
    return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

/// Scalars need their own overload: the one above would be ambiguous with the scalar select.
template <typename F>
OBSCURA_INLINE Vec3<F> select(bool mask, const Vec3<F>& a, const Vec3<F>& b) {
    return mask ? a : b;
}

template <typename F>
OBSCURA_INLINE Vec3<F> abs(const Vec3<F>& a) {
    return {abs(a.x), abs(a.y), abs(a.z)};
}

template <typename F>
OBSCURA_INLINE Vec3<F> max3(const Vec3<F>& a, const Vec3<F>& b) {
    return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)};
}

template <typename F>
OBSCURA_INLINE F max_component(const Vec3<F>& a) {
    return max(a.x, max(a.y, a.z));
}

/// Relative luminance of linear Rec.709 values.
template <typename F>
OBSCURA_INLINE F luminance(const Vec3<F>& rgb) {
    return F(0.2126f) * rgb.x + F(0.7152f) * rgb.y + F(0.0722f) * rgb.z;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
