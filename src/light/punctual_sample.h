// light/punctual_sample.h - light that a point, spot or directional light sends to a point.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/punctual.h"
#include "math/vec.h"

namespace obscura {

/// Distance of a directional light: finite, so that a shadow ray towards it stays safe.
inline constexpr float directional_distance_m = 1e18f;

inline namespace OBSCURA_ISA {

template <typename F>
struct PunctualSample {
    Vec3<F> direction;   ///< unit, towards the light; zero when the point is the light's position
    F distance;          ///< metres; directional_distance_m for directional lights
    Vec3<F> irradiance;  ///< on a surface that faces the light: lux, or W/m^2 by the same scale
};

/// There is one direction only, so there is no density: add bsdf * cosine * irradiance, divided
/// by the probability of choosing this light.
///
/// In      index must be in range for idle lanes too
/// Out     finite at any distance: nearer than 1e-9 m, the light is treated as that far away
/// Source  KHR_lights_punctual: range window, inverse square law and spot cone
template <typename F>
OBSCURA_INLINE PunctualSample<F> sample_punctual(const PunctualLight* rows,
                                                 const IntOf<F>& index,
                                                 const Vec3<F>& from) {
    const IntOf<F> word = index * IntOf<F>(static_cast<int32_t>(sizeof(PunctualLight) / 4));
    const auto read3 = [&](const float* base) {
        return Vec3<F>{gather<F>(base, word), gather<F>(base + 1, word), gather<F>(base + 2, word)};
    };
    const auto type = gather<F>(&rows->type, word);
    const auto directional = type == IntOf<F>(static_cast<int32_t>(PunctualType::directional));
    const auto spot = type == IntOf<F>(static_cast<int32_t>(PunctualType::spot));

    const Vec3<F> shines = read3(rows->direction);
    const Vec3<F> to_light = read3(rows->position) - from;
    const F distance = length(to_light);
    const Vec3<F> towards = to_light * (F(1.0f) / max(distance, F(1e-18f)));

    const F range = gather<F>(&rows->range, word);
    const F reach = distance / max(range, F(1e-18f));
    const F window = clamp(F(1.0f) - square(square(reach)), F(0.0f), F(1.0f));
    const F limited = select(range > F(0.0f), window, F(1.0f));
    const F cone = clamp(-dot(shines, towards) * gather<F>(&rows->spot_scale, word) +
                             gather<F>(&rows->spot_offset, word),
                         F(0.0f),
                         F(1.0f));
    const F angular = select(spot, cone * cone, F(1.0f));
    const F attenuation = limited * angular / max(distance * distance, F(1e-18f));
    const F factor = select(directional, F(1.0f), attenuation);
    return {select(directional, -shines, towards),
            select(directional, F(directional_distance_m), distance),
            read3(rows->intensity) * factor};
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
