// denoise/outliers.h - finds pixels whose light one rare path has brought.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "denoise/planes.h"

namespace obscura {

/// How much of each pixel's light its halves keep: 1 but for outliers.
struct Outliers {
    Plane keep[2];
    double share = 0;  ///< of the pixels: with an outlier in one of the halves
};

/// A half's value is an outlier where it is much brighter than the other half, and than all but a
/// few of the values around it in both halves. What is truly there shows in both.
Outliers find_outliers(const Rgb& first, const Rgb& second);

}  // namespace obscura
