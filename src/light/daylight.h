// light/daylight.h - a clear sky with its sun, as an environment map.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace obscura {

inline constexpr int daylight_width = 2048;
inline constexpr int daylight_height = 1024;

/// Radiance of a white diffuse ground under the sky and sun of make_daylight_pixels.
inline constexpr double daylight_ground = 0.8;

/// A latitude-longitude map, daylight_width x daylight_height, 3 floats a pixel, rows from the top:
/// the sky, a sun of 0.53 degrees, which casts sharp shadows, and a grey ground below the horizon.
/// The whole is scaled so that a white diffuse ground is daylight_ground bright.
///
/// In      elevation_rad: of the sun above the horizon, 0 to pi / 2; azimuth_rad: from +Z
///         towards +X
/// Source  Preetham, Shirley, Smits, "A Practical Analytic Model for Daylight", SIGGRAPH 1999,
///         appendix A (the sky's luminance and colour, Rayleigh scattering); Kasten, Young,
///         "Revised optical air mass tables and approximation formula", Applied Optics 28, 1989
///         (how much air the sun shines through); IESNA Lighting Handbook, 9th edition, ch. 8
///         (the sun's illuminance in a clear sky)
std::vector<float> make_daylight_pixels(double elevation_rad, double azimuth_rad);

}  // namespace obscura
