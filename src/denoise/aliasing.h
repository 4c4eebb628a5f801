// denoise/aliasing.h - how much of the noise comes from edges and textures inside pixels.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "denoise/planes.h"

namespace obscura {

/// The share of the colours' noise that goes with the features' noise, from 0 to 1: in squares of 3
/// pixels, by linear regression of the difference between the halves of each colour on that of the
/// feature that explains it best. By chance alone that is about a quarter.
///
/// In   colors, albedo: two halves, divided by what the surface reflects; normal: two halves
Plane aliasing_share(const Rgb* colors, const Rgb* albedo, const Rgb* normal);

}  // namespace obscura
