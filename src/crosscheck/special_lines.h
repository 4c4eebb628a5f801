// crosscheck/special_lines.h - lines at which formulas divide by nothing, or roots fall together.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/box_tree.h"
#include "crosscheck/random.h"
#include "shape/shape_row.h"
#include "shape/triangle.h"

namespace obscura {

/// Along an axis, a ruling or a surface: through a place near the shape, on it, on a rim or an
/// edge, or through its centre or its point.
///
/// Out  in the shape's space; the origin is the place, the direction's length is 1 but for rounding
TrueRay special_line(const ShapeRow& row, RandomStream& random);

/// Along an edge, an axis or the plane, or across it: through a corner, an edge, or a place beside
/// the triangle in its plane.
TrueRay special_line(const Triangle<double>& triangle, RandomStream& random);

/// A place in the box around a shape, or so many times as far from its centre; of what has no end,
/// within a metre.
Vec3d place_near(const ShapeRow& row, double wider, RandomStream& random);

}  // namespace obscura
