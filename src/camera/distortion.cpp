// camera/distortion.cpp - the largest radius at which lens distortion can be inverted.
// SPDX-License-Identifier: Apache-2.0
#include "camera/distortion.h"

#include <cmath>

namespace obscura {

double largest_radius(double k1, double k2, double k3, double far_away) {
    // d/dr of r (1 + k1 r^2 + k2 r^4 + k3 r^6), as a polynomial in r^2.
    const auto slope = [&](double r) {
        const double s = r * r;
        return 1 + s * (3 * k1 + s * (5 * k2 + s * 7 * k3));
    };
    constexpr int steps = 4096;
    double before = 0;
    for (int i = 1; i <= steps; ++i) {
        // Small steps near the centre, where images are.
        const double fraction = static_cast<double>(i) / steps;
        const double r = far_away * fraction * fraction * fraction;
        if (slope(r) <= 0) {
            double low = before;
            double high = r;
            for (int k = 0; k < 100; ++k) {
                const double middle = 0.5 * (low + high);
                (slope(middle) > 0 ? low : high) = middle;
            }
            return low;
        }
        before = r;
    }
    return far_away;
}

}  // namespace obscura
