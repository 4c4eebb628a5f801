// surface/scattering.h - volume scattering: free flights, places near lights, the phase function.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/warp.h"

#include <cmath>

namespace obscura {

/// Single-scattering albedo of a medium from its multiple-scattering albedo; both in [0, 1].
/// Source  KHR_materials_volume_scatter, after Kulla and Conty, "Revisiting Physically Based
///         Shading at Imageworks", SIGGRAPH 2017 course
inline double single_scatter_albedo(double multi_scatter) {
    const double a = multi_scatter;
    const double root = 4.09712 + 4.20863 * a - std::sqrt(9.59217 + 41.6808 * a + 17.7126 * a * a);
    const double albedo = 1 - root * root;
    return albedo < 0 ? 0 : (albedo > 1 ? 1 : albedo);
}

inline namespace OBSCURA_ISA {

/// Cosine between the old and the new direction of travel, for a uniform number in [0, 1).
/// In      g: mean of that cosine, in (-1, 1)
/// Source  Henyey and Greenstein, "Diffuse Radiation in the Galaxy", Astrophysical Journal 93, 1941
template <typename F>
OBSCURA_INLINE F sample_henyey_greenstein(const F& g, const F& u) {
    const F one(1.0f);
    const auto isotropic = abs(g) < F(1e-3f);
    const F some = select(isotropic, one, g);
    const F root = (one - some * some) / (one - some + F(2.0f) * some * u);
    const F cosine = (one + some * some - root * root) / (F(2.0f) * some);
    return clamp(select(isotropic, one - F(2.0f) * u, cosine), F(-1.0f), one);
}

/// Value of the phase function, 1/sr: also the density with which scatter_direction turns a path.
/// In      g: as for sample_henyey_greenstein; cosine: between the directions of travel before and
///         after
/// Source  as above
template <typename F>
OBSCURA_INLINE F henyey_greenstein(const F& g, const F& cosine) {
    const F one(1.0f);
    const F some = select(abs(g) < F(1e-3f), F(0.0f), g);  // sampled as if isotropic
    const F square = max(one + some * (some - F(2.0f) * cosine), F(1e-12f));
    return exact_constant<F>(0.25 / pi_d) * (one - some * some) / (square * sqrt(square));
}

/// Direction after a scattering.
/// In      direction: unit, of travel; u: uniform in [0, 1)^2
template <typename F>
OBSCURA_INLINE Vec3<F> scatter_direction(const Vec3<F>& direction, const F& g, const Vec2<F>& u) {
    const F cosine = sample_henyey_greenstein(g, u.x);
    const F sine = sqrt(max(F(1.0f) - cosine * cosine, F(0.0f)));
    const SinCos<F> turn = sin_cos_turn(u.y);
    const Vec3<F> local{sine * turn.cos, sine * turn.sin, cosine};
    return normalize(to_world(frame_around(direction), local));
}

/// A sampled free-flight distance, and its weights by channel.
template <typename F>
struct FreeFlight {
    F distance_m;
    Vec3<F> scattered;  ///< weight of the path if it scatters at distance_m
    Vec3<F> passed;     ///< weight if it first reaches the surface at `limit_m`
};

/// Samples a free flight. The distance follows one channel, chosen with its `probability`; the
/// weights of the result hold for all three.
///
/// In      extinction, 1/m; albedo: scattering / extinction; probability: of the channels, sum 1;
///         limit_m: distance of the surface; u: uniform in [0, 1)^2
/// Source  balance heuristic over the channels: Veach, PhD thesis, 1997, ch. 9.2
template <typename F>
OBSCURA_INLINE FreeFlight<F> sample_flight(const Vec3<F>& extinction,
                                           const Vec3<F>& albedo,
                                           const Vec3<F>& probability,
                                           const F& limit_m,
                                           const Vec2<F>& u) {
    const auto red = u.x < probability.x;
    const auto green = (!red) & (u.x < probability.x + probability.y);
    const F sigma = select(red, extinction.x, select(green, extinction.y, extinction.z));
    const F depth = -log(max(F(1.0f) - u.y, F(1e-8f)));
    const auto never = sigma <= F(0.0f);
    FreeFlight<F> flight;
    flight.distance_m = select(never, F(3e38f), depth / select(never, F(1.0f), sigma));
    const auto left = [&](const F& distance) {
        return Vec3<F>{exp(-(extinction.x * distance)),
                       exp(-(extinction.y * distance)),
                       exp(-(extinction.z * distance))};
    };
    const Vec3<F> at_end = extinction * left(min(flight.distance_m, limit_m));
    const Vec3<F> at_limit = left(limit_m);
    const F least(1e-30f);
    flight.scattered = albedo * at_end * (F(1.0f) / max(dot(probability, at_end), least));
    flight.passed = at_limit * (F(1.0f) / max(dot(probability, at_limit), least));
    return flight;
}

/// Equiangular sampling of the segment of a ray through a medium past a light without size.
template <typename F>
struct EquiangularSegment {
    F ahead_m;  ///< from the ray's start to where it is nearest to the light; negative: behind
    F aside_m;  ///< from there to the light, above 0
    F end_m;    ///< of the part of the ray that is sampled, above 0

    /// Angle at the light between start and end.
    F angle() const {
        return atan2(aside_m * end_m, aside_m * aside_m - ahead_m * (end_m - ahead_m));
    }
    /// Distance along the ray with a density that is inverse to the squared distance from the
    /// light: equal angles are equally likely.
    ///
    /// In      u: uniform in [0, 1)
    /// Source  Kulla and Fajardo, "Importance Sampling Techniques for Path Tracing in Participating
    ///         Media", Computer Graphics Forum 31(4), 2012
    F sample(const F& u) const {
        const SinCos<F> turned = sin_cos_turn(angle() * u * exact_constant<F>(0.5 / pi_d));
        const F across = aside_m * turned.cos + ahead_m * turned.sin;
        const F along = turned.sin * (aside_m * aside_m + ahead_m * ahead_m);
        return clamp(along / max(across, F(1e-30f)), F(0.0f), end_m);
    }
    /// Density of sample(), 1/m.
    F pdf(const F& distance_m) const {
        const F beyond = distance_m - ahead_m;
        const F density =
            aside_m / (max(angle(), F(1e-30f)) * (aside_m * aside_m + beyond * beyond));
        return select(distance_m <= end_m, density, F(0.0f));
    }
};

}  // namespace OBSCURA_ISA
}  // namespace obscura
