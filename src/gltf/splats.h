// gltf/splats.h - the colours of Gaussian splats that are drawn as points.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace obscura {

/// The colour that a splat has from all sides, as COLOR_0 would say it: linear, with the opacity as
/// alpha (1 where there are no opacities).
///
/// In      harmonics: 3 coefficients of degree 0 a splat; opacities: one a splat, or none
///         linear: the colours have no sRGB curve
/// Source  KHR_gaussian_splatting, "Calculating color from Spherical Harmonics"
std::vector<float> splat_colors(const std::vector<float>& harmonics,
                                const std::vector<float>& opacities,
                                bool linear);

}  // namespace obscura
