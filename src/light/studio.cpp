// light/studio.cpp - draws the built-in studio environment.
// SPDX-License-Identifier: Apache-2.0
#include "light/studio.h"

#include "math/vec.h"
#include "math/warp.h"

#include <algorithm>
#include <cmath>

namespace obscura {
namespace {

double smooth_step(double low, double high, double x) {
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

/// A rectangular soft box that faces the subject.
struct SoftBox {
    Vec3d towards;      ///< its centre, seen from the subject; any length
    double half_width;  ///< as tangents of angles
    double half_height;
    double edge;  ///< width of the border over which it fades, same unit
    double radiance;
};

double radiance_of(const SoftBox& box, const Vec3d& direction) {
    const Vec3d axis = normalize(box.towards);
    const Vec3d right = normalize(cross(Vec3d{0, 1, 0}, axis));
    const Vec3d up = cross(axis, right);
    const double along = dot(direction, axis);
    if (along <= 0) return 0;
    const double x = std::abs(dot(direction, right)) / along;
    const double y = std::abs(dot(direction, up)) / along;
    const double inside_x = 1 - smooth_step(box.half_width - box.edge, box.half_width, x);
    const double inside_y = 1 - smooth_step(box.half_height - box.edge, box.half_height, y);
    return box.radiance * inside_x * inside_y;
}

/// A seamless background that is brighter towards the top.
double dome(const Vec3d& direction) {
    return 0.22 + 0.38 * smooth_step(-0.45, 0.95, direction.y);
}

}  // namespace

std::vector<float> make_studio_pixels() {
    const SoftBox boxes[] = {
        {{-0.85, 0.75, 0.75}, 0.50, 0.40, 0.14, 9.0},  // key
        {{1.00, 0.25, 0.55}, 0.45, 0.65, 0.30, 1.3},   // fill
        {{0.35, 0.60, -1.00}, 0.65, 0.18, 0.08, 5.0},  // rim
    };
    std::vector<float> pixels;
    pixels.reserve(static_cast<size_t>(studio_width) * studio_height * 3);
    for (int y = 0; y < studio_height; ++y) {
        const double theta = pi_d * (y + 0.5) / studio_height;
        for (int x = 0; x < studio_width; ++x) {
            const double phi = 2 * pi_d * ((x + 0.5) / studio_width - 0.5);
            const Vec3d direction{
                std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
            double radiance = dome(direction);
            for (const SoftBox& box : boxes)
                radiance += radiance_of(box, direction);
            pixels.insert(pixels.end(), 3, static_cast<float>(radiance));
        }
    }
    return pixels;
}

}  // namespace obscura
