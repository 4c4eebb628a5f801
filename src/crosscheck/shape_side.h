// crosscheck/shape_side.h - on which side of a shape a point lies, by the shape's definition alone.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shape/shape_row.h"

namespace obscura {

/// Nothing of src/shape is used here but the row's numbers.
inline Vec3d centre_of(const ShapeRow& row) {
    return {row.centre[0], row.centre[1], row.centre[2]};
}
inline Vec3d size_of(const ShapeRow& row) {
    return {row.size[0], row.size[1], row.size[2]};
}
inline bool is_quadric(const ShapeRow& row) {
    return row.kind == static_cast<int32_t>(ShapeKind::quadric) ||
           row.kind == static_cast<int32_t>(ShapeKind::quadric_from_above);
}
/// Planes and disks.
inline bool is_flat(const ShapeRow& row) {
    return row.kind == static_cast<int32_t>(ShapeKind::plane) ||
           row.kind == static_cast<int32_t>(ShapeKind::disk);
}

/// Below 0 inside, or behind a flat or open shape; above 0 outside. Metres, but for quadrics, and
/// beside a slanted side. Along every line through a solid it falls and then rises (it is convex).
double side_of_shape(const ShapeRow& row, const Vec3d& point);

/// Distance from the hull of two balls, negative inside; one may hold the other.
///
/// Source  its meridian: I. Quilez, "Distance functions" (round cone)
double side_of_hull(const Vec3d (&middle)[2], const double (&radius)[2], const Vec3d& point);

/// The sum of the sizes of the terms of a quadric's equation: what rounding is relative to.
///
/// In   point: relative to the centre; past: how many terms count, the quadratic ones are the first
/// 6
double terms_of_quadric(const ShapeRow& row, const Vec3d& point, size_t past = 10);

/// Unit, towards where side_of_shape rises most, by its differences; along a line on which it is
/// least where it rises to both sides alike, as from a plane squared.
Vec3d normal_of_shape(const ShapeRow& row, const Vec3d& point);

}  // namespace obscura
