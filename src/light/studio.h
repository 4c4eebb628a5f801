// light/studio.h - the built-in studio environment, which lights scenes that have no light.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace obscura {

inline constexpr int studio_width = 256;
inline constexpr int studio_height = 128;

/// A latitude-longitude map, studio_width x studio_height, 3 floats a pixel, rows from the top:
/// a soft grey dome, a large key light on the left, a fill on the right, a rim light behind (the
/// subject faces +Z). Every pixel is grey; the mean radiance over the sphere is about 0.7.
std::vector<float> make_studio_pixels();

}  // namespace obscura
