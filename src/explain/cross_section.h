// explain/cross_section.h - cuts the scene by the plane that holds a ray and a normal.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "explain/pixel_report.h"

namespace obscura {

/// A position in the plane, metres: x along the ray from its origin, y across it.
struct PlanePoint {
    double x = 0, y = 0;
};

struct PlaneSegment {
    PlanePoint from, to;
};

/// The section of one object.
struct Outline {
    crosscheck::Item item;
    std::vector<PlaneSegment> segments;
};

struct CrossSection {
    Vec3d origin = {0, 0, 0};                         ///< of the ray
    Vec3d along = {1, 0, 0};                          ///< the ray's direction
    Vec3d across = {0, 1, 0};                         ///< in the plane, at right angles to it
    Vec3d out = {0, 0, 1};                            ///< at right angles to the plane
    double x_low = 0, x_high = 1, half_height = 0.5;  ///< the part that is shown, metres
    std::vector<Outline> outlines;

    PlanePoint project(const Vec3d& p) const {
        return {dot(p - origin, along), dot(p - origin, across)};
    }
};

/// Cuts the objects around the report's ray by the plane of incidence, which holds the ray and the
/// normal where it ends; without a hit, by an upright plane.
///
/// In      aspect: width / height of the part that is shown
CrossSection cut_scene(const crosscheck::TrueScene& scene,
                       const PixelReport& report,
                       double aspect);

}  // namespace obscura
