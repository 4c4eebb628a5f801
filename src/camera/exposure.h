// camera/exposure.h - exposure value and exposure scale of photographic settings.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace obscura {

/// Exposure value at ISO 100: log2(N^2 / t * 100 / S).
///
/// In      fstop N, shutter t in seconds, iso S; all > 0
/// Source  ISO 2720:1974
inline double exposure_value(double fstop, double shutter_s, double iso) {
    return std::log2(fstop * fstop / shutter_s * 100.0 / iso);
}

/// Factor on luminances in nits that maps the saturation luminance, 1.2 * 2^EV100 nits, to 1: for a
/// lens that loses 35 % and the saturation-based speed of ISO 12232:2006.
///
/// Source  Lagarde and de Rousiers, "Moving Frostbite to PBR", SIGGRAPH course, 2014, section 5.1
inline double exposure_scale(double ev100) {
    return 1.0 / (1.2 * std::exp2(ev100));
}

}  // namespace obscura
