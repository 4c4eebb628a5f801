// crosscheck/special_lines.h - lines at which formulas degenerate: zero divisors, equal roots.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/box_tree.h"
#include "crosscheck/random.h"
#include "shape/shape_record.h"
#include "shape/triangle.h"

namespace obscura::crosscheck {

/// Along an axis, a ruling or a surface: through a point near the shape, on it, on a rim or an
/// edge, or through its centre or apex.
///
/// Out  in the shape's space; the origin is that point, the direction is unit within rounding
TrueRay special_line(const ShapeRecord& record, RandomStream& random);

/// Along an edge, an axis or the plane, or across it: through a corner, an edge, or a point beside
/// the triangle in its plane.
TrueRay special_line(const Triangle<double>& triangle, RandomStream& random);

/// A random point in the box around a shape, or so many times further from its centre; for an
/// infinite shape within a metre.
Vec3d point_near(const ShapeRecord& record, double wider, RandomStream& random);

}  // namespace obscura::crosscheck
