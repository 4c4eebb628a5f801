// light/punctual.h - the record of a punctual light (KHR_lights_punctual, EXT_lights_ies).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace obscura {

enum class PunctualType : int32_t { point = 0, spot = 1, directional = 2 };

/// One light in world space, 32-bit words only.
struct PunctualLight {
    int32_t type = 0;  ///< PunctualType
    float position[3] = {0, 0, 0};
    float direction[3] = {0, 0, -1};  ///< unit, the way the light shines; a profile's polar axis
    /// colour * intensity: candela (point, spot) or lux (directional); factors of a profile
    float intensity[3] = {1, 1, 1};
    float range = 0;  ///< metres; 0 is unlimited
    /// A spot's cone by h = 1 - cosine of the angle to its axis, which keeps narrow cones' digits:
    /// clamp(spot_on_axis - spot_scale * h, 0, 1). It is the extension's formula with
    /// lightAngleScale, and lightAngleOffset + lightAngleScale. 0 and 1 are no cone.
    float spot_scale = 0;
    float spot_on_axis = 1;
    int32_t profile = -1;  ///< of a point: a LightProfile that holds the candela; -1: none
    float zero_axis[3] = {1, 0, 0};  ///< of the profile, unit, at right angles to direction
};

static_assert(sizeof(PunctualLight) == 17 * 4, "read as 32-bit words: no padding");

}  // namespace obscura
