// denoise/features.h - albedo and normal without their own noise.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "denoise/planes.h"

namespace obscura {

/// A feature layer and what noise is left in it.
struct CleanFeature {
    Rgb mean;
    Plane variance;  ///< of the mean, summed over the channels
};

/// Filters a feature by its own halves: motion, lenses and edges make noise in it, too.
CleanFeature clean_feature(const Rgb* halves);

/// (a - b)^2 / 4, summed over the channels: the variance of the mean of two halves as one pixel
/// tells it.
Plane halves_variance(const Rgb& first, const Rgb& second);

}  // namespace obscura
