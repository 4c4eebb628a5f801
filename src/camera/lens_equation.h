// camera/lens_equation.h - image distance and circle of confusion of a thin lens.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace obscura {

/// Distance behind the lens at which a point is sharp: 1/f = 1/z + 1/z'.
///
/// In      focal_m > 0; distance_m > focal_m, may be infinite
inline double image_distance(double focal_m, double distance_m) {
    return 1.0 / (1.0 / focal_m - 1.0 / distance_m);
}

/// Diameter on the film of the image of a point at distance_m when the lens is focused at focus_m:
/// c = A / z' * |z'_focus - z'|.
///
/// Units   metres; diameter_m is the lens opening's
/// Source  Potmesil and Chakravarty, "Synthetic Image Generation with a Lens and Aperture Camera
///         Model", ACM TOG 1(2), 1982
inline double circle_of_confusion(double diameter_m,
                                  double focal_m,
                                  double focus_m,
                                  double distance_m) {
    const double sharp = image_distance(focal_m, distance_m);
    return diameter_m / sharp * std::abs(image_distance(focal_m, focus_m) - sharp);
}

}  // namespace obscura
