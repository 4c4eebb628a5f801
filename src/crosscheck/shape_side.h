// crosscheck/shape_side.h - on which side of a shape a point lies, by definition.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shape/shape_record.h"

namespace obscura::crosscheck {

/// Uses only the record's numbers, and no formula of src/shape.
inline Vec3d centre_of(const ShapeRecord& record) {
    return {record.centre[0], record.centre[1], record.centre[2]};
}
inline Vec3d size_of(const ShapeRecord& record) {
    return {record.size[0], record.size[1], record.size[2]};
}
inline bool is_quadric(const ShapeRecord& record) {
    return record.kind == static_cast<int32_t>(ShapeKind::quadric) ||
           record.kind == static_cast<int32_t>(ShapeKind::quadric_from_above);
}
/// Planes and disks.
inline bool is_flat(const ShapeRecord& record) {
    return record.kind == static_cast<int32_t>(ShapeKind::plane) ||
           record.kind == static_cast<int32_t>(ShapeKind::disk);
}

/// Below 0 inside, or behind a flat or open shape; above 0 outside. Metres, but for quadrics, and
/// beside a slanted side. Along every line through a solid it falls and then rises (it is convex).
double side_of_shape(const ShapeRecord& record, const Vec3d& point);

/// Distance from the hull of two balls, negative inside; one may hold the other.
///
/// Source  its meridian: I. Quilez, "Distance functions" (round cone)
double side_of_hull(const Vec3d (&middle)[2], const double (&radius)[2], const Vec3d& point);

/// The sum of the sizes of the terms of a quadric's equation, the scale of its rounding.
///
/// In   point: relative to the centre; past: how many terms count, the quadratic ones are the first
/// 6
double terms_of_quadric(const ShapeRecord& record, const Vec3d& point, size_t past = 10);

/// Unit direction of the steepest rise of side_of_shape, by its differences; at a minimum along a
/// line, as of a squared plane, the direction that rises to both sides alike.
Vec3d normal_of_shape(const ShapeRecord& record, const Vec3d& point);

}  // namespace obscura::crosscheck
