// light/punctual_sample.h - the irradiance of a point, spot or directional light at a point.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/light_profile.h"
#include "light/punctual.h"
#include "light/record_words.h"
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

/// One light for each lane, as PunctualLight.
template <typename F>
struct PunctualValues {
    IntOf<F> type, profile;
    Vec3<F> position, shines;
    Vec3<F> zero_axis;  ///< read where there are profiles
    Vec3<F> intensity;
    F range, spot_scale, spot_on_axis;
};

/// In      index must be in range for idle lanes too; has_profiles: some light may have one
template <typename F>
OBSCURA_INLINE PunctualValues<F> read_punctual(const PunctualLight* lights,
                                               const IntOf<F>& index,
                                               bool has_profiles) {
    const IntOf<F> word = index * IntOf<F>(words_per_record<PunctualLight>);
    const auto read = [&](size_t offset) {
        return gather<F>(member_words<float>(lights, offset), word);
    };
    const auto read3 = [&](size_t offset) {
        return Vec3<F>{read(offset), read(offset + 4), read(offset + 8)};
    };
    PunctualValues<F> out;
    out.type = gather<F>(member_words<int32_t>(lights, offsetof(PunctualLight, type)), word);
    out.position = read3(offsetof(PunctualLight, position));
    out.shines = read3(offsetof(PunctualLight, direction));
    out.intensity = read3(offsetof(PunctualLight, intensity));
    out.range = read(offsetof(PunctualLight, range));
    out.spot_scale = read(offsetof(PunctualLight, spot_scale));
    out.spot_on_axis = read(offsetof(PunctualLight, spot_on_axis));
    out.profile = IntOf<F>(-1);
    out.zero_axis = splat3(F(0.0f));
    if (has_profiles) {
        out.profile =
            gather<F>(member_words<int32_t>(lights, offsetof(PunctualLight, profile)), word);
        out.zero_axis = read3(offsetof(PunctualLight, zero_axis));
    }
    return out;
}

/// Interpolates a light between two poses.
template <typename F>
OBSCURA_INLINE PunctualValues<F> blend(const PunctualValues<F>& a,
                                       const PunctualValues<F>& b,
                                       const F& fraction) {
    const auto mix = [&](const auto& p, const auto& q) { return p + (q - p) * fraction; };
    const auto turn = [&](const Vec3<F>& p, const Vec3<F>& q) {
        const Vec3<F> between = mix(p, q);
        return between * (F(1.0f) / max(length(between), F(1e-18f)));
    };
    PunctualValues<F> out = a;
    out.position = mix(a.position, b.position);
    out.shines = turn(a.shines, b.shines);
    out.zero_axis = turn(a.zero_axis, b.zero_axis);
    out.intensity = mix(a.intensity, b.intensity);
    out.range = mix(a.range, b.range);
    out.spot_scale = mix(a.spot_scale, b.spot_scale);
    out.spot_on_axis = mix(a.spot_on_axis, b.spot_on_axis);
    return out;
}

/// Samples a light whose direction is unique, so that there is no density: add bsdf * cosine *
/// irradiance, divided by the probability of choosing this light.
///
/// In      profiles: of lights that have one
/// Out     finite at any distance for intensities up to 1e20 cd: nearer than 1e-9 m, the light is
///         treated as that far away
/// Source  KHR_lights_punctual: range window, inverse square law and spot cone; EXT_lights_ies
template <typename F>
OBSCURA_INLINE PunctualSample<F> sample_punctual(const PunctualValues<F>& light,
                                                 const Vec3<F>& from,
                                                 const LightProfileView& profiles = {}) {
    const auto directional =
        light.type == IntOf<F>(static_cast<int32_t>(PunctualType::directional));
    const auto spot = light.type == IntOf<F>(static_cast<int32_t>(PunctualType::spot));

    const Vec3<F> to_light = light.position - from;
    const F distance = length(to_light);
    const Vec3<F> towards = to_light * (F(1.0f) / max(distance, F(1e-18f)));

    const F reach = distance / max(light.range, F(1e-18f));
    const F window = clamp(F(1.0f) - square(square(reach)), F(0.0f), F(1.0f));
    const F limited = select(light.range > F(0.0f), window, F(1.0f));
    const Vec3<F> chord = light.shines + towards;  // for unit vectors |chord|^2 = 2 (1 - cosine)
    const F beside_axis = F(0.5f) * dot(chord, chord);
    const F cone = clamp(light.spot_on_axis - light.spot_scale * beside_axis, F(0.0f), F(1.0f));
    F angular = select(spot, cone * cone, F(1.0f));
    if (profiles.records != nullptr) {
        const MaskOf<F> measured = light.profile >= IntOf<F>(0);
        if (any(measured)) {
            const F candela = profile_candela<F>(profiles,
                                                 max(light.profile, IntOf<F>(0)),
                                                 {light.shines, light.zero_axis},
                                                 -towards);
            angular = select(measured, candela, angular);
        }
    }
    const F attenuation = limited * angular / max(distance * distance, F(1e-18f));
    const F factor = select(directional, F(1.0f), attenuation);
    return {select(directional, -light.shines, towards),
            select(directional, F(directional_distance_m), distance),
            light.intensity * factor};
}

/// The same of lights[index].
template <typename F>
OBSCURA_INLINE PunctualSample<F> sample_punctual(const PunctualLight* lights,
                                                 const IntOf<F>& index,
                                                 const Vec3<F>& from,
                                                 const LightProfileView& profiles = {}) {
    return sample_punctual<F>(
        read_punctual<F>(lights, index, profiles.records != nullptr), from, profiles);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
