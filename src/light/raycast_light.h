// light/raycast_light.h - noise-free lights of --integrator raycast: point sources and irradiance.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/punctual_sample.h"

#include <cstdint>

namespace obscura {

/// An emissive surface as a point light, 32-bit words only.
struct CentreLight {
    float position[3] = {0, 0, 0};   ///< mean of the surface, weighted by its emission
    float normal[3] = {0, 1, 0};     ///< of a flat one, unit
    float intensity[3] = {0, 0, 0};  ///< candela, or W/sr: along the normal, or to all sides
    float min_distance_squared = 0;  ///< m^2; at smaller distances the brightness is constant
    float radius = 0;                ///< metres; shadow rays end this far before the position
    int32_t flat = 0;       ///< 1: emits by the cosine with the normal; 0: equally to all sides
    int32_t two_sided = 0;  ///< of a flat one
};

static_assert(sizeof(CentreLight) == 13 * 4, "read as 32-bit words: no padding");

inline constexpr int ambient_terms = 9;

/// Irradiance of the environment by surface normal: red, green and blue factors of the terms of
/// ambient_basis.
struct AmbientLight {
    float k[ambient_terms][3] = {};
};

/// The lights of raycast besides the punctual ones.
struct RaycastView {
    const CentreLight* centres = nullptr;
    int32_t centre_count = 0;
    const AmbientLight* ambient = nullptr;  ///< null: no environment
    bool headlight = false;                 ///< light from the eye, if there is no other light
};

/// Irradiance of the headlight on a surface that faces the eye: white surfaces get the radiance 1.
inline constexpr float headlight_irradiance = 3.14159265358979324f;

inline namespace OBSCURA_ISA {

/// Light of lights[index] at a point.
///
/// Source  the definition of radiant intensity; Lambert's cosine law for flat emitters; a convex
///         body shows a quarter of its surface on average (Cauchy, 1841)
template <typename F>
OBSCURA_INLINE PunctualSample<F> sample_centre_light(const CentreLight* lights,
                                                     int32_t index,
                                                     const Vec3<F>& from) {
    const CentreLight& light = lights[index];
    const auto vector = [](const float* v) { return Vec3<F>{F(v[0]), F(v[1]), F(v[2])}; };
    const Vec3<F> to_light = vector(light.position) - from;
    const F squared = dot(to_light, to_light);
    const F distance = sqrt(squared);
    PunctualSample<F> out;
    out.direction = to_light * (F(1.0f) / max(distance, F(1e-18f)));
    F factor = F(1.0f) / max(max(squared, F(light.min_distance_squared)), F(1e-18f));
    if (light.flat != 0) {
        const F cosine = -dot(out.direction, vector(light.normal));
        factor = factor * max(light.two_sided != 0 ? abs(cosine) : cosine, F(0.0f));
    }
    out.distance = max(distance - F(light.radius), F(0.0f));
    out.irradiance = vector(light.intensity) * factor;
    return out;
}

/// The functions of a unit normal whose factors AmbientLight holds.
template <typename F>
struct AmbientBasis {
    F term[ambient_terms];
};

template <typename F>
OBSCURA_INLINE AmbientBasis<F> ambient_basis(const Vec3<F>& n) {
    return {{F(1.0f),
             n.x,
             n.y,
             n.z,
             n.x * n.y,
             n.y * n.z,
             n.z * n.x,
             F(3.0f) * n.z * n.z - F(1.0f),
             n.x * n.x - n.y * n.y}};
}

/// Irradiance on a surface with the unit normal n, without occlusion.
///
/// Errors  up to a few percent of the mean for an environment with a small bright light
/// Source  Ramamoorthi and Hanrahan, "An Efficient Representation for Irradiance Environment Maps",
///         SIGGRAPH 2001
template <typename F>
OBSCURA_INLINE Vec3<F> ambient_irradiance(const AmbientLight& light, const Vec3<F>& n) {
    const AmbientBasis<F> basis = ambient_basis(n);
    Vec3<F> sum = splat3(F(0.0f));
    for (int i = 0; i < ambient_terms; ++i)
        sum = sum + Vec3<F>{F(light.k[i][0]), F(light.k[i][1]), F(light.k[i][2])} * basis.term[i];
    return max3(sum, splat3(F(0.0f)));
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
