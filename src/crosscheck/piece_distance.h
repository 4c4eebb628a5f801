// crosscheck/piece_distance.h - how far a place is from a piece of a line.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shape/segment.h"

#include <cmath>

namespace obscura {

/// Metres from a piece's surface, negative inside.
///
/// Source  the hull of two spheres by its meridian: I. Quilez, "Distance functions" (round cone)
inline double piece_distance(const SegmentFrame<double>& frame, const Vec3d& place) {
    const Capsule<double>& c = frame.capsule;
    const Vec3d own = into_frame(frame, place - frame.centre);
    const double across = std::hypot(own.x, own.z);
    const double along = own.y + c.half_height;
    const double length_m = 2 * c.half_height;
    const double sine = (c.bottom - c.top) / length_m;
    const double cosine = std::sqrt(1 - sine * sine);
    const double height = cosine * along - sine * across;
    if (height < 0) return std::hypot(across, along) - c.bottom;
    if (height > cosine * length_m) return std::hypot(across, along - length_m) - c.top;
    return cosine * across + sine * along - c.bottom;
}

}  // namespace obscura
