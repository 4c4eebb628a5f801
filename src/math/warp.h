// math/warp.h - maps from the unit square to directions, and orthonormal frames.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"

#include <type_traits>

namespace obscura {

inline constexpr float pi_f = 3.14159265358979324f;
inline constexpr double pi_d = 3.14159265358979324;
inline constexpr double radians_per_degree = pi_d / 180;

inline namespace OBSCURA_ISA {

/// A constant in the full precision of F.
template <typename F>
OBSCURA_INLINE F exact_constant(double value) {
    if constexpr (std::is_same_v<F, double>) {
        return value;
    } else {
        return F(static_cast<float>(value));
    }
}

template <typename F>
struct SinCos {
    F sin, cos;
};

/// Sine and cosine of an angle plus a number of quarter turns, from those of the angle.
///
/// In   quarters: whole
template <typename F>
OBSCURA_INLINE SinCos<F> turned_by_quarters(const SinCos<F>& of, const F& quarters) {
    const auto q = to_int(quarters);
    const auto odd = (q & IntOf<F>(1)) == IntOf<F>(1);
    const auto sine_negative = (q & IntOf<F>(2)) == IntOf<F>(2);
    const auto cosine_negative = ((q + IntOf<F>(1)) & IntOf<F>(2)) == IntOf<F>(2);
    const F sine = select(odd, of.cos, of.sin);
    const F cosine = select(odd, of.sin, of.cos);
    return {select(sine_negative, -sine, sine), select(cosine_negative, -cosine, cosine)};
}

/// Sine and cosine of an angle, in lanes to about one unit in the last place.
///
/// In      |angle| at most a few turns, radians
/// Source  Cody and Waite, "Software Manual for the Elementary Functions", 1980 (reduction in three
///         parts); coefficients: Moshier, Cephes library, sinf and cosf
template <typename F>
OBSCURA_INLINE SinCos<F> sin_cos(const F& angle) {
    if constexpr (std::is_floating_point_v<F>) {
        return {sin(angle), cos(angle)};
    } else {
        // Not xsimd's own: they contain a scalar function for huge angles, which the linker might
        // share between instruction sets.
        const F quadrant = floor(angle * F(2.0f / pi_f) + F(0.5f));
        const F x = ((angle - quadrant * F(1.5703125f)) - quadrant * F(4.837512969970703125e-4f)) -
                    quadrant * F(7.549789948768648e-8f);
        const F x2 = x * x;
        const F s =
            x + x * x2 *
                    (F(-1.6666654611e-1f) + x2 * (F(8.3321608736e-3f) + x2 * F(-1.9515295891e-4f)));
        const F c = F(1.0f) - F(0.5f) * x2 +
                    x2 * x2 *
                        (F(4.166664568298827e-2f) +
                         x2 * (F(-1.388731625493765e-3f) + x2 * F(2.443315711809948e-5f)));
        return turned_by_quarters({s, c}, quadrant);
    }
}

/// Sine and cosine of t turns, t in [0, 1]; absolute error below 4e-7 in float.
template <typename F>
OBSCURA_INLINE SinCos<F> sin_cos_turn(const F& t) {
    if constexpr (std::is_same_v<F, double>) {
        return {sin(2.0 * pi_d * t), cos(2.0 * pi_d * t)};
    } else {
        // Reduce to an eighth of a turn on both sides of a quadrant's axis, then Taylor series.
        const F quadrant = floor(F(4.0f) * t + F(0.5f));
        const F x = (F(4.0f) * t - quadrant) * F(0.5f * pi_f);
        const F x2 = x * x;
        const F s =
            x * (F(1.0f) + x2 * (F(-1.0f / 6) + x2 * (F(1.0f / 120) + x2 * F(-1.0f / 5040))));
        const F c =
            F(1.0f) +
            x2 * (F(-0.5f) + x2 * (F(1.0f / 24) + x2 * (F(-1.0f / 720) + x2 * F(1.0f / 40320))));
        return turned_by_quarters({s, c}, quadrant);
    }
}

/// Direction on the upper hemisphere with density cos(theta) / pi.
template <typename F>
OBSCURA_INLINE Vec3<F> cosine_hemisphere(const Vec2<F>& u) {
    const SinCos<F> turn = sin_cos_turn(u.y);
    const F radius = sqrt(u.x);
    return {radius * turn.cos, radius * turn.sin, sqrt(max(F(1.0f) - u.x, F(0.0f)))};
}

/// Direction on the whole sphere with density 1 / 4 pi.
template <typename F>
OBSCURA_INLINE Vec3<F> uniform_sphere(const Vec2<F>& u) {
    const SinCos<F> turn = sin_cos_turn(u.y);
    const F z = F(1.0f) - F(2.0f) * u.x;
    const F radius = sqrt(max(F(1.0f) - z * z, F(0.0f)));
    return {radius * turn.cos, radius * turn.sin, z};
}

/// Two tangents that complete a unit normal to a right-handed frame.
template <typename F>
struct Frame {
    Vec3<F> tangent, bitangent, normal;
};

/// Source  Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017
template <typename F>
OBSCURA_INLINE Frame<F> frame_around(const Vec3<F>& n) {
    const F sign = select(n.z >= F(0.0f), F(1.0f), F(-1.0f));
    const F a = F(-1.0f) / (sign + n.z);
    const F b = n.x * n.y * a;
    return {{F(1.0f) + sign * n.x * n.x * a, sign * b, -(sign * n.x)},
            {b, sign + n.y * n.y * a, -n.y},
            n};
}

template <typename F>
OBSCURA_INLINE Vec3<F> to_world(const Frame<F>& frame, const Vec3<F>& v) {
    return frame.tangent * v.x + frame.bitangent * v.y + frame.normal * v.z;
}

template <typename F>
OBSCURA_INLINE Vec3<F> to_local(const Frame<F>& frame, const Vec3<F>& v) {
    return {dot(v, frame.tangent), dot(v, frame.bitangent), dot(v, frame.normal)};
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
