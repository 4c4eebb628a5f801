// scene/points_lines_radii.cpp - sets the radii of points and lines.
// SPDX-License-Identifier: Apache-2.0
#include "scene/points_lines_radii.h"

#include <algorithm>

namespace obscura {

namespace {

constexpr double min_radius_m = 1e-18;  // squares of less vanish in single precision

float radius_at(const RadiusAt& radius, const Vec3d& position_m) {
    return static_cast<float>(std::max(radius(position_m), min_radius_m));
}

}  // namespace

void set_points_lines_radii(Scene& scene, const RadiusAt& of_points, const RadiusAt& of_lines) {
    for (const Primitive& primitive : scene.primitives) {
        const bool spheres = primitive.geometry == static_cast<int32_t>(GeometryKind::spheres);
        if (!spheres || !is_point_or_line(primitive)) continue;
        for (int32_t i = 0; i < primitive.triangle_count; ++i) {
            float* at = &scene.spheres[sphere_word(static_cast<size_t>(primitive.first_triangle) +
                                                   static_cast<size_t>(i))];
            at[3 * sphere_block] =
                radius_at(of_points, {at[0], at[sphere_block], at[2 * sphere_block]});
        }
    }
    for (size_t i = 0; i < scene.curve_points.size(); i += 4) {
        float* at = &scene.curve_points[i];
        at[3] = radius_at(of_lines, {at[0], at[1], at[2]});
    }
}

void set_default_points_lines_radii(Scene& scene) {
    constexpr double diameters_a_diagonal = 500;
    constexpr double alone_m = 0.01;  // for a single point: the scene has no extent
    const Vec3f extent = scene.bounds.high - scene.bounds.low;
    const double diagonal = static_cast<double>(length(extent));
    const double radius = diagonal > 0 ? 0.5 * diagonal / diameters_a_diagonal : 0.5 * alone_m;
    const RadiusAt everywhere = [radius](const Vec3d&) { return radius; };
    set_points_lines_radii(scene, everywhere, everywhere);
}

}  // namespace obscura
