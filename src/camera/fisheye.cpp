// camera/fisheye.cpp - the largest angle of each fisheye law.
// SPDX-License-Identifier: Apache-2.0
#include "camera/fisheye.h"

namespace obscura {

double largest_fisheye_angle(FisheyeLaw law, const double k[4]) {
    if (law == FisheyeLaw::orthographic) return 0.5 * pi_d;
    // 2 tan(theta / 2) is infinite at pi: the field of view is limited to 359 degrees.
    if (law == FisheyeLaw::stereographic) return 179.5 / 180.0 * pi_d;
    if (law != FisheyeLaw::opencv) return pi_d;
    const auto slope = [&](double theta) {
        const double s = theta * theta;
        return 1 + s * (3 * k[0] + s * (5 * k[1] + s * (7 * k[2] + s * 9 * k[3])));
    };
    constexpr int steps = 4096;
    for (int i = 1; i <= steps; ++i) {
        if (slope(pi_d * i / steps) > 0) continue;
        double low = pi_d * (i - 1) / steps;
        double high = pi_d * i / steps;
        for (int n = 0; n < 100; ++n) {
            const double middle = 0.5 * (low + high);
            (slope(middle) > 0 ? low : high) = middle;
        }
        return low;
    }
    return pi_d;
}

}  // namespace obscura
