// image/pbr_neutral.h - the Khronos PBR Neutral tone curve in closed form.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace obscura {

/// Compresses highlights above 0.8 and leaves the rest of the range nearly as it is, so that base
/// colours look as they were authored.
///
/// In      rgb: linear Rec.709, not negative
/// Out     rgb: linear Rec.709 in [0, 1]
/// Source  Khronos PBR Neutral Tone Mapper, specification, KhronosGroup/ToneMapping, 2024
template <typename F>
void tone_map_pbr_neutral(F rgb[3]) {
    constexpr F f90 = F(0.04);             // reflectance of a dielectric with ior 1.5
    constexpr F start = F(0.8) - F(0.04);  // compression begins here
    constexpr F desaturation_speed = F(0.15);

    const F smallest = std::min({rgb[0], rgb[1], rgb[2]});
    const F offset = smallest <= F(2) * f90 ? smallest - smallest * smallest / (F(4) * f90) : f90;
    for (int i = 0; i < 3; ++i)
        rgb[i] -= offset;

    const F peak = std::max({rgb[0], rgb[1], rgb[2]});
    if (peak <= start) return;
    const F room = F(1) - start;
    const F new_peak = F(1) - room * room / (peak + room - start);
    const F saturation = F(1) / (desaturation_speed * (peak - new_peak) + F(1));
    for (int i = 0; i < 3; ++i) {
        rgb[i] = rgb[i] * (new_peak / peak) * saturation + new_peak * (F(1) - saturation);
    }
}

}  // namespace obscura
