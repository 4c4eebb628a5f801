// light/punctual_sample.h - light that a point, spot or directional light sends to a point.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/light_profile.h"
#include "light/punctual.h"
#include "light/row_words.h"
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
/// In      index must be in range for idle lanes too; profiles: of lights that have one
/// Out     finite at any distance for intensities up to 1e20 cd: nearer than 1e-9 m, the light is
///         treated as that far away
/// Source  KHR_lights_punctual: range window, inverse square law and spot cone; EXT_lights_ies
template <typename F>
OBSCURA_INLINE PunctualSample<F> sample_punctual(const PunctualLight* rows,
                                                 const IntOf<F>& index,
                                                 const Vec3<F>& from,
                                                 const LightProfileView& profiles = {}) {
    const IntOf<F> word = index * IntOf<F>(words_per_row<PunctualLight>);
    const auto read = [&](size_t offset) {
        return gather<F>(member_words<float>(rows, offset), word);
    };
    const auto read3 = [&](size_t offset) {
        return Vec3<F>{read(offset), read(offset + 4), read(offset + 8)};
    };
    const auto type = gather<F>(member_words<int32_t>(rows, offsetof(PunctualLight, type)), word);
    const auto directional = type == IntOf<F>(static_cast<int32_t>(PunctualType::directional));
    const auto spot = type == IntOf<F>(static_cast<int32_t>(PunctualType::spot));

    const Vec3<F> shines = read3(offsetof(PunctualLight, direction));
    const Vec3<F> to_light = read3(offsetof(PunctualLight, position)) - from;
    const F distance = length(to_light);
    const Vec3<F> towards = to_light * (F(1.0f) / max(distance, F(1e-18f)));

    const F range = read(offsetof(PunctualLight, range));
    const F reach = distance / max(range, F(1e-18f));
    const F window = clamp(F(1.0f) - square(square(reach)), F(0.0f), F(1.0f));
    const F limited = select(range > F(0.0f), window, F(1.0f));
    const F cone = clamp(-dot(shines, towards) * read(offsetof(PunctualLight, spot_scale)) +
                             read(offsetof(PunctualLight, spot_offset)),
                         F(0.0f),
                         F(1.0f));
    F angular = select(spot, cone * cone, F(1.0f));
    if (profiles.rows != nullptr) {
        const auto profile =
            gather<F>(member_words<int32_t>(rows, offsetof(PunctualLight, profile)), word);
        const MaskOf<F> measured = profile >= IntOf<F>(0);
        if (any(measured)) {
            const F candela =
                profile_candela<F>(profiles,
                                   max(profile, IntOf<F>(0)),
                                   {shines, read3(offsetof(PunctualLight, zero_axis))},
                                   -towards);
            angular = select(measured, candela, angular);
        }
    }
    const F attenuation = limited * angular / max(distance * distance, F(1e-18f));
    const F factor = select(directional, F(1.0f), attenuation);
    return {select(directional, -shines, towards),
            select(directional, F(directional_distance_m), distance),
            read3(offsetof(PunctualLight, intensity)) * factor};
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
